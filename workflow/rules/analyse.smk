# slips, mu_sapp

TABLES |= {
    "reproduction": {
        "function": "maegawa2010.paper.scene_numbers:reproduction_table",
        "inputs": {"slips": {scene: f"results/tables/{scene}_slips.csv" for scene in SCENES}},
        "options": {"paper": PAPER_PRINTS},
    },
}


rule mu_sapp:
    input:
        "results/tables/reproduction.csv",
        "results/tables/definitions.csv",
    localrule: True
