from maegawa2010.studies.work_precision.tables import work_precision_table
from maegawa2010.support.job import job, read
from precursors.proof.certificate import Certificate
from precursors.support.files import write_table

with job() as snakemake:
    certificate = read(Certificate.load, snakemake.input.certificate)
    params = snakemake.params
    table = work_precision_table(certificate, params.scene, params.full)
    write_table(table, snakemake.output[0])
