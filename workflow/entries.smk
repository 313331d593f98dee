# The jobs and targets of the entries that the files of rules list.

from maegawa2010.entries import listed

made = {name: [] for name in [*TABLES, *FIGURES, *ENSEMBLES]}  # by all entries of a name
for name in ENSEMBLES:
    made[name] += chunks_of(study=name)
for name in FIGURES:
    made[name] += collect("results/figures/{name}.{kind}", name=name, kind=FORMATS)
for name, table in TABLES.items():
    made[name] += sum(table.outputs(name), [])

for name, table in TABLES.items():
    files = [file for files in table.inputs.values() for file in listed(files)]
    called = {table.function, *(READERS[Path(file).suffix] for file in files)}
    shown, beside = table.outputs(name)

    rule:
        name:
            f"tabulate_{name}"
        input:
            files,
            table.also,
        output:
            [report(path, category="Tables") for path in shown],
            beside,
        log:
            f"results/logs/tabulate_{name}.log",
        localrule: not table.seconds
        threads: table.threads
        resources:
            seconds=table.seconds,
        params:
            function=table.function,
            inputs=table.inputs,
            options=table.options,
            readers=READERS,
            code=digest("make_tables", *sorted(function.split(":")[0] for function in called)),
        message:
            table.message
        script:
            "scripts/make_tables.py"


wildcard_constraints:
    study="|".join(ENSEMBLES),
    chunk="[0-9]+of[0-9]+",


rule run_chunk:
    output:
        chunk="results/ensembles/{study}/{chunk}.csv",
    log:
        "results/logs/run_chunk/{study}_{chunk}.log",
    resources:
        seconds=lambda wildcards: ENSEMBLES[wildcards.study].seconds,
    params:
        function=lambda wildcards: ENSEMBLES[wildcards.study].function,
        options=lambda wildcards: ENSEMBLES[wildcards.study].options,
        run=lambda wildcards: ENSEMBLES[wildcards.study].run,
        code=lambda wildcards: digest("run_chunk", ENSEMBLES[wildcards.study].function.split(":")[0]),
    message:
        "{wildcards.study}: running chunk {wildcards.chunk} of its chains"
    script:
        "scripts/run_chunk.py"


for section in {figure.section: None for figure in FIGURES.values()}:
    drawn = {name: figure for name, figure in FIGURES.items() if figure.section == section}

    rule:
        name:
            f"draw_{section}"
        input:
            [listed(files) for figure in drawn.values() for files in figure.tables.values()],
        output:
            [
                report(
                    f"results/figures/{name}.svg",
                    caption=f"report/{figure.caption or name}.rst",
                    category=section.capitalize(),
                    labels={"figure": f"{name}: {figure.shows}"},
                )
                for name, figure in drawn.items()
            ],
            collect("results/figures/{name}.{kind}", name=drawn, kind=FORMATS[1:]),
        log:
            f"results/logs/draw_{section}.log",
        localrule: True
        params:
            figures={name: asdict(figure) for name, figure in drawn.items()},
            readers=READERS,
            code=digest("draw", *sorted({figure.function.split(":")[0] for figure in drawn.values()})),
        message:
            f"drawing the figures of {section}: {', '.join(drawn)}"
        script:
            "scripts/draw.py"


# A target for each file of rules, and for each section of the figures.
targets = {part: [*results, *(made[name] for name in names)] for part, (names, results) in parts.items()}
for section in {figure.section: None for figure in FIGURES.values()}:
    drawn = {name for name, figure in FIGURES.items() if figure.section == section}
    targets[section] = [made[name] for names, _ in parts.values() if names & drawn for name in names]
for target, results in targets.items():

    rule:
        name:
            target
        input:
            results,
        localrule: True


# All results but their provenance, which comes after them. What other results are made from is asked for as well: it is
# made again where it was deleted.
RESULTS += made.values()


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
    message:
        "writing where the results come from"
    script:
        "scripts/write_provenance.py"


for scene in {rule.name for rule in workflow.rules} & set(config["scenes"]):
    raise WorkflowError(f"configuration: scenes.{scene} has the name of a target: give it another one")
