# The page on which the loads are changed and the blocks move


rule write_explorer:
    """Write the page on which the loads are changed and the blocks move."""
    input:
        page=sorted(
            path for path in (PAPERS / "explorer").iterdir() if path.suffix in (".js", ".css", ".html")
        ),
        slips=collect("results/tables/{scene}_slips.csv", scene=scenes_with_theta(config)),
    output:
        page="results/explorer.html",
    log:
        "results/logs/write_explorer.log",
    localrule: True
    params:
        sliders=[scene_slider(config, scene) for scene in scenes_with_theta(config)],
        proved=config["horizon"]["proved"],
        numbers={"duration": config["duration"], "tolerance": config["horizon"]["tolerance"]},
        code=digest("write_explorer"),
    message:
        "writing the page results/explorer.html"
    script:
        "../scripts/write_explorer.py"


rule explorer:
    """The page results/explorer.html."""
    input:
        rules.write_explorer.output,
    localrule: True
