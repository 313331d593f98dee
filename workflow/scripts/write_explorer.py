"""Write the explorer: one HTML page that solves the chain in the browser."""

from job import job

from precursors.figures.explorer.page import Scene, write_explorer

if __name__ == "__main__":
    with job() as snakemake:
        scenes = [
            Scene(name, snakemake.params.titles[name], slider)
            for name, slider in snakemake.params.sliders.items()
        ]
        write_explorer(scenes, snakemake.params.duration, snakemake.output.page)
