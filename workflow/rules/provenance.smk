rule write_provenance:
    """Write the versions, the machine, and checksums of all inputs and results."""
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


# Snakemake would take the figure of another rule for that of the scene.
drawn = {Path(file).stem for rule in workflow.rules for file in rule.output if "/figures/" in file}
for scene in {*drawn, *(rule.name for rule in workflow.rules)} & set(config["scenes"]):
    raise WorkflowError(
        f"configuration: scenes.{scene} has the name of a target or a figure: give it another one"
    )
