# Eq. 15, readings

TABLES |= {
    "eq15": {
        "function": "maegawa2010.paper.eq15:eq15_table",
        "inputs": {"runs": RUNS},
        "options": {"duration": config["duration"]},
        "seconds": 2,
    },
    "definitions": {
        "function": "maegawa2010.paper.definitions:definitions_table",
        "inputs": {"runs": list(RUNS.values())},
        "options": {
            "slider": config["chain"],
            "duration": config["duration"],
            "degrees": config["reproduction"]["theta"],
            "load_drops": config["reproduction"]["load_drop"],
            "paper": [PAPER_PRINTS[scene] for scene in config["fig13"]],
        },
    },
}


rule eq15:
    input:
        "results/tables/eq15.csv",
    localrule: True
