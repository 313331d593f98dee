# slips, mu_sapp

TABLES |= {
    "reproduction": {
        "function": "reproduction.scene_numbers:reproduction_tables",
        "inputs": {"slips": {scene: f"results/tables/{scene}_slips.csv" for scene in SCENES}},
        "options": {"paper": PAPER_PRINTS},
        "tables": ["mu_sapp", "reproduction"],
    },
}


rule mu_sapp:
    input:
        "results/tables/mu_sapp.csv",
        "results/tables/reproduction.csv",
        "results/tables/definitions.csv",
    localrule: True
