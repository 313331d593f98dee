# Figs. 9-13, pages

# Every figure that is drawn from tables, by its file: its section, which one job draws; what it shows; its caption, a file
# of workflow/report, and its module of precursors.figures, if they have other names than the figure; the tables, which
# are arguments of the module's function `draw`, its other arguments, and its look where the configuration has one.
FIGURES = {
    **{
        scene: {
            "section": "reproduction",
            "shows": config["scenes"][scene]["title"],
            "caption": "scene",
            "module": "precursors.figures.scene",
            "tables": {
                "slips": f"results/tables/{scene}_slips.csv",
                "trace": f"results/tables/{scene}_trace.csv",
            },
            "options": {
                "title": f"{scene.replace('fig', 'Fig. ')}: {config['scenes'][scene]['title']}",
                # one key below the last of those of Fig. 13
                "key": scene not in sorted(config["fig13"])[:-1],
            },
            "look": config["figure"],
        }
        for scene in SCENES
    },
    "fig09": {
        "section": "reproduction",
        "shows": "the model: blocks on springs, pushed through a spring",
        "module": "maegawa2010.paper.chain_schematic",
    },
    "fig13": {
        "section": "reproduction",
        "shows": "lengths of precursors against the load: 6, 9 and 14 are counted",
        "module": "precursors.figures.precursor_lengths",
        "tables": {
            "slips": collect("results/tables/{scene}_slips.csv", scene=config["fig13"]),
        },
        "look": config["figure"],
    },
    "work_precision": {
        "section": "accuracy",
        "shows": "what accuracy costs, in time and in evaluations",
        "module": "maegawa2010.studies.work_precision.figure",
        "tables": {"table": "results/tables/work_precision.csv"},
        "options": {"works": ["seconds", "evaluations"]},
    },
    "speed": {
        "module": "maegawa2010.studies.work_precision.figure",
        "shows": "what accuracy costs, as published",
        "section": "accuracy",
        "tables": {
            "table": str(ROOT / "paper/tables/work_precision_full.csv"),
            "sessions": str(ROOT / "paper/tables/beside_heyoka.csv"),
        },
    },
    "step_sweep": {
        "module": "maegawa2010.studies.step_sweep.figure",
        "section": "accuracy",
        "shows": "the paper's numbers against the step of a Runge-Kutta method",
        "tables": {"table": "results/tables/step_sweep.csv"},
    },
    "failure_gallery": {
        "module": "maegawa2010.studies.failures.figure",
        "section": "accuracy",
        "shows": "nine ways in which methods fail",
        "tables": {
            "thresholds": "results/tables/thresholds.csv",
            "curves": "results/tables/failure_curves.csv",
            "panels": f"{PAPERS}/studies/failures/failure_gallery.csv",
        },
    },
    "horizon": {
        "module": "maegawa2010.studies.horizon.figure",
        "section": "accuracy",
        "shows": "how errors grow, predicted and actual",
        "tables": {
            "errors": "results/tables/horizon.csv",
            "exponents": "results/tables/lyapunov.csv",
        },
        "options": {
            "thetas": THETAS,
            "tolerance": config["accuracy"]["tolerance"],
        },
    },
    "hero": {
        "module": "maegawa2010.studies.printed_digits.figure",
        "shows": "the paper's six numbers, and mu_sapp of the sliders that are printed alike",
        "section": "ensembles",
        "tables": {
            "slips": collect("results/tables/{scene}_slips.csv", scene=config["fig13"]),
            "members": "results/tables/digits_members.csv",
            "shares": "results/tables/digits.csv",
        },
    },
    "theta_window": {
        "module": "maegawa2010.studies.theta_window.figure",
        "shows": "small changes of theta change the numbers",
        "section": "ensembles",
        "tables": {"members": "results/tables/theta_window_members.csv"},
    },
    "resolution": {
        "module": "maegawa2010.studies.resolution.figure",
        "section": "ensembles",
        "shows": "mu_sapp approaches mu_k as the number of blocks grows",
        "tables": {
            "table": "results/tables/resolution.csv",
            "predictability": "results/tables/predictability.csv",
        },
        "options": {"papers_n": config["chain"]["n_blocks"], "mu_k": config["chain"]["mu_k"]},
    },
    "noise": {
        "module": "maegawa2010.studies.noise.figure",
        "section": "ensembles",
        "shows": "mu_sapp is larger at +5/6, however small the noise",
        "tables": {"table": "results/tables/noise_amplitudes.csv"},
    },
    "event_law": {
        "module": "maegawa2010.studies.event_law.figure",
        "section": "ensembles",
        "shows": "the number of events compared with the law",
        "tables": {"table": "results/tables/event_law.csv"},
    },
    "map_theta_friction_ratio": {
        "shows": "mu_sapp over theta and mu_k/mu_s",
        "section": "ensembles",
        "module": "maegawa2010.studies.friction_map.figure",
        "tables": {"table": "results/tables/map_theta_friction_ratio.csv"},
        "options": {
            "scenes": [(slider["theta"], slider["mu_k"] / slider["mu_s"]) for slider in SLIDERS.values()]
        },
    },
    "larger": {
        "module": "maegawa2010.studies.larger.figure",
        "shows": "a chain with a length",
        "section": "hierarchy",
        "tables": {
            name: str(ROOT / f"paper/tables/larger_{name}_full.csv")
            for name in ("nucleation", "peaks", "cycles")
        },
    },
}
# The scene whose first global slip is shown in slow motion: that in the middle.
EVEN = config["fig13"][len(config["fig13"]) // 2]
# Their headings in the report; another section has its own name.
SECTIONS = {
    "reproduction": "Reproduction",
    "accuracy": "Speed and accuracy",
    "ensembles": "Sensitivity",
    "hierarchy": "Models",
}


rule fig13:
    input:
        collect("results/figures/fig13.{kind}", kind=FORMATS),
    localrule: True


rule paper_figures:
    input:
        collect("results/figures/{figure}.{kind}", figure=["fig09", *SCENES, "fig13"], kind=FORMATS),
        "results/figures/wave.svg",
    localrule: True


rule explorer:
    input:
        "results/explorer.html",
    localrule: True


for section in dict.fromkeys(figure["section"] for figure in FIGURES.values()):
    drawn = {name: figure for name, figure in FIGURES.items() if figure["section"] == section}
    modules = {figure["module"] for figure in drawn.values()}

    rule:
        name:
            f"draw_{section}"
        input:
            [list(figure.get("tables", {}).values()) for figure in drawn.values()],
        output:
            [
                report(
                    f"results/figures/{name}.svg",
                    caption=f"../report/{figure.get('caption', name)}.rst",
                    category=SECTIONS.get(section, section),
                    labels={"figure": f"{name}: {figure['shows']}"},
                )
                for name, figure in drawn.items()
            ],
            collect("results/figures/{name}.{kind}", name=drawn, kind=FORMATS[1:]),
        log:
            f"results/logs/draw_{section}.log",
        localrule: True
        params:
            figures=drawn,
            readers=READERS,
            code=digest("draw", *sorted(modules)),
        script:
            "../scripts/draw.py"


rule write_wave:
    input:
        run=RUNS[EVEN],
        slips=f"results/tables/{EVEN}_slips.csv",
    output:
        report(
            "results/figures/wave.svg",
            caption="../report/wave.rst",
            category=SECTIONS["reproduction"],
            labels={"figure": "wave: the first global slip, in slow motion"},
        ),
    log:
        "results/logs/write_wave.log",
    localrule: True
    params:
        code=digest("write_wave"),
    script:
        "../scripts/write_wave.py"


rule write_explorer:
    input:
        page=collect(
            f"{PAPERS}/explorer/{{file}}",
            file=[
                "drawing.js",
                "explorer.css",
                "explorer.js",
                "figures.js",
                "page.html",
                "solver.js",
                "story.js",
                "studies.js",
                "worker.js",
            ],
        ),
        slips=collect("results/tables/{scene}_slips.csv", scene=scenes_with_theta(config)),
    output:
        page="results/explorer.html",
    log:
        "results/logs/write_explorer.log",
    localrule: True
    params:
        sliders=[scene_slider(config, scene) for scene in scenes_with_theta(config)],
        proved=config["accuracy"]["proved"],
        numbers={"duration": config["duration"], "tolerance": config["accuracy"]["tolerance"]},
        code=digest("write_explorer"),
    script:
        "../scripts/write_explorer.py"
