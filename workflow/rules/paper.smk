# claims, paper.pdf, supplement.pdf

import sys

from precursors.model.chain import SLIDER
from maegawa2010.paper.inputs import CLAIM_TABLES, POINT_TABLES
from maegawa2010.paper.inputs import SCENES as PAPERS_SCENES
from maegawa2010.paper.shown import results_shown

PAPER_SOURCE = ROOT / "paper"
FIG13 = config["fig13"]
CLAIMS = (
    ["results/tables/claims.csv", "results/tables/open_points.csv"]
    if set(PAPERS_SCENES) <= set(FIG13)
    else []
)
# The article is about the paper's slider, and is not made for another.
PAPERS_SLIDERS = {
    scene: SLIDER | {"theta": theta} for scene, theta in zip(PAPERS_SCENES, (-5 / 6, 0.0, 5 / 6), strict=True)
}
IS_PAPERS = PAPERS_SLIDERS == {scene: {"weights": None} | SLIDERS.get(scene, {}) for scene in PAPERS_SCENES}
PAPER = ["results/paper.pdf", "results/supplement.pdf"] if IS_PAPERS else []

TABLES |= {
    "measures": {
        "function": "maegawa2010.paper.scene_numbers:measures_table",
        "inputs": {"runs": RUNS},
        "tables": [],
        "beside": ["measures"],
    },
    "claims": {
        "function": "maegawa2010.paper.claims:claims_tables",
        "inputs": {
            "tables": {
                table: f"results/tables/{table}.csv" for table in sorted({*CLAIM_TABLES, *POINT_TABLES})
            }
        },
        "also": [f"{PAPERS}/paper/{said}.csv" for said in ("claims", "open_points")],
        "tables": ["claims", "open_points"],
    },
}


onstart:
    if not IS_PAPERS:
        print(
            "paper.pdf is not made: it is about the paper's slider, and this is another one",
            file=sys.stderr,
        )


rule paper:
    input:
        CLAIMS,
        PAPER,
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
    script:
        "../scripts/write_paper.py"


# All results but their provenance, which comes after them. What other results are made from is asked for as well: it
# is made again where it was deleted.
RESULTS = [
    collect("results/runs/{scene}.h5", scene=SCENES),
    collect("results/tables/{scene}_{kind}.csv", scene=SCENES, kind=["slips", "trace"]),
    [
        f"results/tables/{table}.csv"
        for name, made in TABLES.items()
        if name != "claims" or CLAIMS
        for table in [*made.get("tables", [name]), *made.get("beside", [])]
    ],
    chunks_of(study=STUDIES),
    list(CERTIFICATES.values()),
    rules.paper_figures.input,
    rules.mu_sapp.input,
    rules.eq15.input,
    rules.accuracy.input,
    rules.hierarchy.input,
    rules.ensembles.input,
    rules.explorer.input,
    rules.paper.input,
]


rule write_provenance:
    input:
        RESULTS,
    output:
        json="results/provenance.json",
    log:
        "results/logs/write_provenance.log",
    localrule: True
    params:
        root=str(ROOT),
        config=config,
        code=digest("write_provenance"),
    script:
        "../scripts/write_provenance.py"
