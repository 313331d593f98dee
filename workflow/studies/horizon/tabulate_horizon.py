from maegawa2010.studies.horizon.lyapunov import lyapunov_table
from maegawa2010.studies.horizon.tables import proof_tables
from maegawa2010.support.job import job, read_all, write_tables
from precursors.proof.certificate import Certificate

with job() as snakemake:
    params = snakemake.params
    certificates = read_all(Certificate.load, snakemake.input.certificates)
    tables = proof_tables(certificates, params.tolerance)
    tables["lyapunov"] = lyapunov_table(params.sliders, params.lyapunov_duration)
    write_tables(tables, snakemake.output)
