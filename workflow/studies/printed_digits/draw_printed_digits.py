from maegawa2010.studies.printed_digits.figure import draw
from maegawa2010.support.drawing import save
from maegawa2010.support.job import job, read, read_all
from precursors.support.files import read_table

with job() as snakemake:
    slips = read_all(read_table, snakemake.input.slips)
    members = read(read_table, snakemake.input.members)
    shares = read(read_table, snakemake.input.shares)
    title = "the paper's six numbers, and mu_sapp of the sliders with the same printed inputs"
    save(draw(list(slips.values()), members, shares), snakemake.output, title)
