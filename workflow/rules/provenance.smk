rule write_provenance:
    """Record software versions, the machine, and checksums of all inputs and results."""
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


# A scene must not have the name of a figure or a rule: two rules would write the same figure, or a target be ambiguous.
drawn = {Path(file).stem for rule in workflow.rules for file in rule.output if "/figures/" in file}
for scene in {*drawn, *(rule.name for rule in workflow.rules)} & set(config["scenes"]):
    raise WorkflowError(
        f"configuration: scenes.{scene} has the name of a target or a figure: choose another name"
    )
