from maegawa2010.support.drawing import save
from maegawa2010.support.job import job, read_all
from precursors.figures import precursor_lengths, style
from precursors.support.files import read_table

with job() as snakemake:
    slips = read_all(read_table, snakemake.input.slips)
    look = style.Look(**snakemake.params.look)
    figure = precursor_lengths.draw(list(slips.values()), look=look)
    save(figure, snakemake.output, "lengths of precursors against the load", look)
