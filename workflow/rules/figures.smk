# Every figure that is drawn from tables: what it shows and where it stands in the report, the modules that draw it, its
# tables and its parameters. Rule and script are draw_{name}, the caption is report/{name}.rst.
FIGURES = {
    "fig09": {
        "shows": "the chain",
        "category": "Reproduction",
        "modules": ["chain_schematic"],
    },
    "fig13": {
        "shows": "propagation length against load",
        "category": "Reproduction",
        "modules": ["precursor_lengths"],
        "tables": {"slips": collect("results/tables/{scene}_slips.csv", scene=config["fig13"])},
        "params": {"sliders": list(SLIDERS.values())},
    },
    "definitions": {
        "shows": "what every reading gives",
        "category": "Reproduction",
        "tables": {"table": "results/tables/definitions.csv"},
    },
    "growth": {
        "shows": "time per transition against N",
        "category": "Speed and accuracy",
        "tables": {"table": "results/tables/growth.csv"},
    },
    "step_sweep{full}": {
        "shows": "the paper's numbers against the step",
        "category": "Speed and accuracy",
        "tables": {"table": "results/tables/step_sweep{full}.csv"},
    },
    "failure_gallery": {
        "shows": "how methods fail",
        "category": "Speed and accuracy",
        "tables": {
            "numbers": "results/tables/failures.csv",
            "curves": collect("results/tables/failures/{way}.csv", way=WAYS_TO_FAIL),
        },
    },
    "horizon": {
        "shows": "predicted and actual error",
        "category": "Proof and horizon",
        "tables": {
            "horizon": "results/tables/horizon.csv",
            "summary": "results/tables/solver_vs_proof.csv",
            "lyapunov": "results/tables/lyapunov.csv",
        },
        "params": {
            "chains": CHAINS,
            "thetas": {scene: slider["theta"] for scene, slider in SLIDERS.items()},
            "tolerance": config["accuracy"]["tolerance"],
        },
    },
    "resolution": {
        "shows": "what the number of blocks does",
        "category": "Sensitivity",
        "tables": {
            "table": "results/tables/resolution.csv",
            "limits": "results/tables/resolution_limits.csv",
        },
        "params": {"papers_n": config["chain"]["n_blocks"]},
    },
    "resolution_models": {
        "shows": "the same with viscosity and interface springs",
        "category": "Sensitivity",
        "modules": ["resolution", "resolution_models"],
        "tables": {
            "table": "results/tables/resolution_models.csv",
            "runs": "results/tables/resolution_models_runs.csv",
        },
        "params": {"papers_n": config["chain"]["n_blocks"]},
    },
    "long_runs": {
        "shows": "peak loads of hundreds of global slips",
        "category": "Sensitivity",
        "tables": {
            "slips": "results/tables/long_runs.csv",
            "statistics": "results/tables/long_runs_statistics.csv",
        },
    },
    "ladder": {
        "shows": "which model answers which question",
        "category": "Models",
        "tables": {"ladder": "results/tables/model_comparison.csv"},
    },
}


rule fig13:
    input:
        collect("results/figures/fig13.{kind}", kind=["png", "svg"]),
    localrule: True


rule paper_figures:
    input:
        collect("results/figures/{figure}.{kind}", figure=["fig09", *SCENES, "fig13"], kind=["png", "svg"]),
    localrule: True


rule explorer:
    input:
        "results/explorer.html",
    localrule: True


for figure, about in FIGURES.items():
    name = figure.removesuffix("{full}")
    drawn_by = ["style", *about.get("modules", [name])]

    rule:
        name:
            f"draw_{name}"
        input:
            **about.get("tables", {}),
            code=[
                *package(*[f"figures/{module}" for module in drawn_by]),
                ROOT / f"workflow/scripts/draw_{name}.py",
            ],
        output:
            png=f"results/figures/{figure}.png",
            svg=report(
                f"results/figures/{figure}.svg",
                caption=f"../report/{name}.rst",
                category=about["category"],
                labels={"figure": f"{figure}: {about['shows']}"},
            ),
        log:
            f"results/logs/draw_{figure}.log",
        localrule: True
        params:
            **about.get("params", {}),
            script=f"draw_{name}",  # a script's path is read late, when `name` is the last one
        script:
            "../scripts/{params.script}.py"


rule draw_scene:
    input:
        slips="results/tables/{scene}_slips.csv",
        trace="results/tables/{scene}_trace.csv",
        code=package("figures/style", "figures/scene"),
    output:
        png="results/figures/{scene}.png",
        svg=report(
            "results/figures/{scene}.svg",
            caption="../report/scene.rst",
            category="Reproduction",
            labels={"figure": "{scene}: load and slips over time"},
        ),
    log:
        "results/logs/draw_scene/{scene}.log",
    localrule: True
    params:
        slider=lambda wildcards: scene_slider(config, wildcards.scene),
        title=lambda wildcards: config["scenes"][wildcards.scene]["title"],
    script:
        "../scripts/draw_scene.py"


rule draw_work_precision:
    input:
        table="results/tables/work_precision{full}.csv",
        code=package("figures/style", "figures/work_precision"),
    output:
        time_png="results/figures/work_precision{full}.png",
        time_svg=report(
            "results/figures/work_precision{full}.svg",
            caption="../report/work_precision.rst",
            category="Speed and accuracy",
            labels={"figure": "work_precision{full}: errors against time"},
        ),
        evaluations_png="results/figures/work_precision_evaluations{full}.png",
        evaluations_svg=report(
            "results/figures/work_precision_evaluations{full}.svg",
            caption="../report/work_precision_evaluations.rst",
            category="Speed and accuracy",
            labels={"figure": "work_precision_evaluations{full}: errors against evaluations"},
        ),
    log:
        "results/logs/draw_work_precision{full}.log",
    localrule: True
    script:
        "../scripts/draw_work_precision.py"


rule draw_spread:
    input:
        members="results/tables/spread_members.csv",
        spread="results/tables/spread.csv",
        code=package("figures/style", "figures/spread"),
    output:
        collect("results/figures/spread_{question}.png", question=QUESTIONS),
        [
            report(
                f"results/figures/spread_{question}.svg",
                caption="../report/spread.rst",
                category="Sensitivity",
                labels={"figure": f"spread_{question}: changes of {question}"},
            )
            for question in QUESTIONS
        ],
    log:
        "results/logs/draw_spread.log",
    localrule: True
    params:
        questions=[*QUESTIONS, *QUESTIONS],
    script:
        "../scripts/draw_spread.py"


rule draw_maps:
    input:
        table="results/tables/{map}.csv",
        code=package("figures/style", "figures/maps"),
    output:
        png="results/figures/{map}.png",
        svg=report(
            "results/figures/{map}.svg",
            caption="../report/maps.rst",
            category="Sensitivity",
            labels={"figure": "{map}: two parameters"},
        ),
    log:
        "results/logs/draw_maps/{map}.log",
    localrule: True
    params:
        sliders=list(SLIDERS.values()),
    script:
        "../scripts/draw_maps.py"


rule write_explorer:
    input:
        page=collect(
            f"{LIBRARY}/figures/explorer/{{file}}",
            file=["explorer.css", "explorer.js", "page.html", "solver.js"],
        ),
        code=package("figures/style", "figures/explorer", "support/files"),
    output:
        page="results/explorer.html",
    log:
        "results/logs/write_explorer.log",
    localrule: True
    params:
        titles={scene: config["scenes"][scene]["title"] for scene in SCENES},
        sliders={scene: scene_slider(config, scene) for scene in SCENES},
        duration=config["duration"],
    script:
        "../scripts/write_explorer.py"
