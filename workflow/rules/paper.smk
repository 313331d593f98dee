# Eq. 15, readings, claims, Fig. 9, paper.pdf, supplement.pdf

import sys

from maegawa2010.paper.inputs import CLAIM_TABLES, POINT_TABLES
from maegawa2010.paper.shown import results_shown

PAPER_SOURCE = ROOT / "paper"
# The article is about the paper's slider, and is not made for another.
PAPER = ["results/paper.pdf", "results/supplement.pdf"] if IS_PAPERS else []

TABLES["eq15"] = Table(
    function="maegawa2010.paper.eq15:eq15_table",
    message="checking Eq. 15 by algebra and in the runs",
    inputs={"runs": RUNS},
    options={"duration": config["duration"]},
    seconds=2,
)
TABLES["definitions"] = Table(
    function="maegawa2010.paper.definitions:definitions_table",
    message="counting by other readings of the paper's words",
    inputs={"runs": list(RUNS.values())},
    options={
        "slider": config["chain"],
        "duration": config["duration"],
        "degrees": config["definitions"]["theta"],
        "load_drops": config["definitions"]["load_drop"],
        "paper": [PAPER_PRINTS[scene] for scene in FIG13],
    },
)
TABLES["measures"] = Table(
    function="maegawa2010.paper.scene_numbers:measures_table",
    message="measuring the scenes",
    inputs={"runs": RUNS},
    tables=[],
    beside=["measures"],
)
if set(PAPERS_SCENES) <= set(FIG13):
    TABLES["claims"] = Table(
        function="maegawa2010.paper.claims:claims_tables",
        message="judging the paper's claims",
        inputs={
            "tables": {
                table: f"results/tables/{table}.csv" for table in sorted({*CLAIM_TABLES, *POINT_TABLES})
            }
        },
        also=[f"{PAPERS}/paper/{said}.csv" for said in ("claims", "open_points")],
        tables=["claims", "open_points"],
    )

FIGURES["fig09"] = Figure(
    section="reproduction",
    function="maegawa2010.paper.chain_schematic:draw",
    shows="the model: blocks on springs, pushed through a spring",
)


onstart:
    if not IS_PAPERS:
        print(
            "paper.pdf is not made: it is about the paper's slider, and this is another one",
            file=sys.stderr,
        )


rule eq15:
    input:
        "results/tables/eq15.csv",
    localrule: True


rule write_paper:
    input:
        shown=lambda wildcards: results_shown(PAPER_SOURCE / f"{wildcards.document}.typ"),
        main=PAPER_SOURCE / "{document}.typ",
        source=sorted(path for path in PAPER_SOURCE.rglob("*.*") if path.is_file()),
    output:
        "results/{document}.pdf",
    log:
        "results/logs/write_{document}.log",
    wildcard_constraints:
        document="paper|supplement",
    localrule: True
    params:
        code=digest("write_paper"),
    message:
        "setting {output}"
    script:
        "../scripts/write_paper.py"


RESULTS += PAPER
