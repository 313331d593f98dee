# Figs. 9-13, pages

# Every figure that is drawn from tables: what it shows and where it stands in the report, its tables, and its options.
# The rule is draw_{name}, the caption report/{name}.rst. The file is {name} or "file", and the module of
# precursors.figures that draws it is {name} or "module".
FIGURES = {
    "fig09": {
        "shows": "the chain",
        "category": "Reproduction",
        "module": "chain_schematic",
    },
    "scene": {
        "file": "{scene}",
        "shows": "load and slips over time",
        "category": "Reproduction",
        "tables": {
            "slips": "results/tables/{scene}_slips.csv",
            "trace": "results/tables/{scene}_trace.csv",
            # The scenes of Fig. 13 have one load axis.
            "others": lambda wildcards: [
                f"results/tables/{scene}_trace.csv"
                for scene in config["fig13"]
                if wildcards.scene in config["fig13"]
            ],
        },
        "options": {"title": lambda wildcards: config["scenes"][wildcards.scene]["title"]},
    },
    "fig13": {
        "shows": "propagation length against load",
        "category": "Reproduction",
        "module": "precursor_lengths",
        "tables": {
            "slips": collect("results/tables/{scene}_slips.csv", scene=config["fig13"]),
            "mu_sapp": "results/tables/mu_sapp.csv",
        },
        "options": {
            "printed": [
                config["scenes"][scene].get("paper", {}).get("events_counted") for scene in config["fig13"]
            ],
            "scenes": config["fig13"],
        },
    },
    "definitions": {
        "shows": "what every reading gives",
        "category": "Reproduction",
        "tables": {"table": "results/tables/definitions.csv"},
    },
    "work_precision": {
        "file": "work_precision{full}",
        "shows": "errors against time",
        "category": "Speed and accuracy",
        "tables": {"table": "results/tables/work_precision{full}.csv"},
    },
    "work_precision_evaluations": {
        "file": "work_precision_evaluations{full}",
        "shows": "errors against evaluations",
        "category": "Speed and accuracy",
        "module": "work_precision",
        "tables": {"table": "results/tables/work_precision{full}.csv"},
        "options": {"work": "evaluations"},
    },
    "speed": {
        "shows": "error against time, as published",
        "category": "Speed and accuracy",
        "tables": {"table": ROOT / "paper/tables/work_precision_full.csv"},
    },
    "step_sweep": {
        "file": "step_sweep{full}",
        "shows": "the paper's numbers against the step",
        "category": "Speed and accuracy",
        "tables": {"table": "results/tables/step_sweep{full}.csv"},
    },
    "failure_gallery": {
        "shows": "how methods fail",
        "category": "Speed and accuracy",
        "tables": {
            "thresholds": "results/tables/thresholds.csv",
            "curves": collect("results/tables/failures/{mode}.csv", mode=FAILURE_MODES),
        },
    },
    "horizon": {
        "shows": "predicted and actual error",
        "category": "Proof and horizon",
        "tables": {
            "errors": "results/tables/horizon.csv",
            "overview": "results/tables/solver_vs_proof.csv",
            "exponents": "results/tables/lyapunov.csv",
        },
        "options": {"chains": CHAINS, "tolerance": config["accuracy"]["tolerance"]},
    },
    "noise": {
        "shows": "mu_sapp and counts over noise and printed digits",
        "category": "Sensitivity",
        "tables": {
            "noise": "results/tables/noise_members.csv",
            "digits": "results/tables/digits_members.csv",
        },
    },
    "theta_window": {
        "shows": "a window of theta",
        "category": "Sensitivity",
        "tables": {"members": "results/tables/theta_window_members.csv"},
    },
    "resolution": {
        "shows": "what the number of blocks does",
        "category": "Sensitivity",
        "tables": {
            "table": "results/tables/resolution.csv",
            "limits": "results/tables/resolution_limits.csv",
            "predictability": "results/tables/predictability.csv",
        },
        "options": {"papers_n": config["chain"]["n_blocks"]},
    },
    "event_law": {
        "file": "event_law{full}",
        "shows": "the number of events by theory",
        "category": "Sensitivity",
        "tables": {"table": "results/tables/event_law{full}.csv"},
    },
    "map_theta_friction_ratio": {
        "shows": "theta and mu_k/mu_s",
        "category": "Sensitivity",
        "module": "friction_map",
        "tables": {"table": "results/tables/map_theta_friction_ratio.csv"},
        "options": {
            "scenes": [(slider["theta"], slider["mu_k"] / slider["mu_s"]) for slider in SLIDERS.values()]
        },
    },
    "model_comparison": {
        "shows": "which model answers which question",
        "category": "Models",
        "tables": {"table": "results/tables/model_comparison.csv"},
    },
}


rule fig13:
    input:
        collect("results/figures/fig13.{kind}", kind=FORMATS),
    localrule: True


rule paper_figures:
    input:
        collect("results/figures/{figure}.{kind}", figure=["fig09", *SCENES, "fig13"], kind=FORMATS),
    localrule: True


rule explorer:
    input:
        "results/explorer.html",
    localrule: True


for name, about in FIGURES.items():
    file, module = about.get("file", name), about.get("module", name)

    rule:
        name:
            f"draw_{name}"
        input:
            **about.get("tables", {}),
        output:
            report(
                f"results/figures/{file}.svg",
                caption=f"../report/{name}.rst",
                category=about["category"],
                labels={"figure": f"{file}: {about['shows']}"},
            ),
            *[f"results/figures/{file}.{kind}" for kind in FORMATS[1:]],
        log:
            f"results/logs/draw_{name}/{file}.log",
        localrule: True
        params:
            **about.get("options", {}),
            figure=module,
            code=digest("draw", f"figures.{module}"),
        script:
            "../scripts/draw.py"


rule write_explorer:
    input:
        page=collect(
            f"{LIBRARY}/figures/explorer/{{file}}",
            file=["drawing.js", "explorer.css", "explorer.js", "page.html", "solver.js", "worker.js"],
        ),
        slips=collect("results/tables/{scene}_slips.csv", scene=scenes_with_theta(config)),
    output:
        page="results/explorer.html",
    log:
        "results/logs/write_explorer.log",
    localrule: True
    params:
        titles=[config["scenes"][scene]["title"] for scene in scenes_with_theta(config)],
        sliders=[scene_slider(config, scene) for scene in scenes_with_theta(config)],
        proved=config["accuracy"]["proved"],
        duration=config["duration"],
        code=digest("write_explorer"),
    script:
        "../scripts/write_explorer.py"
