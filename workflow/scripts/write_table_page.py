"""Write a table as a web page, for the report."""

from job import job

from precursors.figures.table_page import write_table_page

if __name__ == "__main__":
    with job() as snakemake:
        write_table_page(snakemake.input.table, snakemake.output.page)
