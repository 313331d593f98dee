from maegawa2010.studies.printed_digits.figure import draw
from maegawa2010.support.drawing import save
from maegawa2010.support.job import job, read, read_all
from precursors.support.files import read_table

with job() as snakemake:
    slips = read_all(read_table, snakemake.input.slips)
    noise = read(read_table, snakemake.input.noise)
    members = read(read_table, snakemake.input.members)
    shares = read(read_table, snakemake.input.shares)
    all_six = shares[shares["question"] == "all_six"].iloc[0]
    figure = draw(list(slips.values()), noise, members, all_six)
    title = "the paper's six numbers, and how often the counts survive noise and other digits"
    save(figure, snakemake.output, title)
