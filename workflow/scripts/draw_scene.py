from maegawa2010.support.drawing import save
from maegawa2010.support.job import job, read
from precursors.figures import scene, style
from precursors.support.files import read_table

with job() as snakemake:
    params = snakemake.params
    name = snakemake.wildcards.scene.replace("fig", "Fig. ")
    look = style.Look(**params.look)
    figure = scene.draw(
        read(read_table, snakemake.input.slips),
        read(read_table, snakemake.input.trace),
        title=f"{name}: {params.title}",
        look=look,
        has_key=params.has_key,
    )
    save(figure, snakemake.output, params.title, look)
