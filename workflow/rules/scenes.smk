rule simulate_scene:
    """Simulate a scene, and find every transition between stick and slip."""
    output:
        run="results/runs/{scene}.h5",
        slips=report("results/tables/{scene}_slips.csv", category="Tables"),
        trace="results/tables/{scene}_trace.csv",
    log:
        "results/logs/simulate_scene/{scene}.log",
    resources:
        seconds=1,
    params:
        slider=lambda wildcards: scene_slider(config, wildcards.scene),
        duration=lambda wildcards: scene_duration(config, wildcards.scene),
        code=digest("simulate_scene"),
    script:
        "../scripts/simulate_scene.py"


rule draw_scene:
    """Draw the load and the slips of a scene (Figs. 10-12)."""
    input:
        slips="results/tables/{scene}_slips.csv",
        trace="results/tables/{scene}_trace.csv",
    output:
        report(
            "results/figures/{scene}.svg",
            caption="../report/scene.rst",
            category="Reproduction",
            labels=lambda wildcards: scene_label(config, wildcards.scene),
        ),
        collect("results/figures/{{scene}}.{kind}", kind=MORE_FORMATS),
    log:
        "results/logs/draw_scene/{scene}.log",
    localrule: True
    params:
        title=lambda wildcards: config["scenes"][wildcards.scene]["title"],
        look=config["figure"],
        # The article stacks the scenes of Fig. 13, so only the last one has a legend.
        has_key=lambda wildcards: wildcards.scene not in sorted(FIG13)[:-1],
        code=digest("draw_scene"),
    script:
        "../scripts/draw_scene.py"


rule fig13:
    """Draw the lengths of precursors against the load (Fig. 13)."""
    input:
        slips=SLIPS,
    output:
        report(
            "results/figures/fig13.svg",
            caption="../report/fig13.rst",
            category="Reproduction",
            labels={"figure": "fig13: lengths of precursors against the load"},
        ),
        collect("results/figures/fig13.{kind}", kind=MORE_FORMATS),
    log:
        "results/logs/fig13.log",
    localrule: True
    params:
        look=config["figure"],
        code=digest("fig13"),
    script:
        "../scripts/fig13.py"


rule mu_sapp:
    """Compare mu_sapp and the number of events with the paper."""
    input:
        runs=RUNS,
        slips=collect("results/tables/{scene}_slips.csv", scene=SCENES),
    output:
        reproduction=report("results/tables/reproduction.csv", category="Tables"),
        definitions=report("results/tables/definitions.csv", category="Tables"),
        measures="results/tables/measures.csv",
    log:
        "results/logs/mu_sapp.log",
    localrule: True
    params:
        paper={scene: printed.SCENES.get(scene, {}) for scene in SCENES},
        slider=config["chain"],
        duration=config["duration"],
        settings=config["definitions"],
        code=digest("mu_sapp"),
    script:
        "../scripts/mu_sapp.py"


SHOWN = FIG13[len(FIG13) // 2]


rule draw_slips:
    """Draw three slips of the middle scene of Fig. 13: spring forces along the row, and a film in slow motion."""
    input:
        run=f"results/runs/{SHOWN}.h5",
        slips=f"results/tables/{SHOWN}_slips.csv",
    output:
        wave=report(
            "results/figures/wave.svg",
            caption="../report/wave.rst",
            category="Reproduction",
            labels={"figure": "wave: two precursors and the global slip, in slow motion"},
        ),
        push=report(
            "results/figures/push.svg",
            caption="../report/push.rst",
            category="Reproduction",
            labels={"figure": "push: what a slip adds and releases, and how far it can reach"},
        ),
        more=collect("results/figures/push.{kind}", kind=MORE_FORMATS),
    log:
        "results/logs/draw_slips.log",
    localrule: True
    params:
        look=config["figure"],
        code=digest("draw_slips"),
    script:
        "../scripts/draw_slips.py"


rule scenes:
    """Runs, tables and figures of the scenes."""
    input:
        collect("results/runs/{scene}.h5", scene=SCENES),
        collect("results/tables/{scene}_{kind}.csv", scene=SCENES, kind=["slips", "trace"]),
        collect("results/figures/{scene}.{kind}", scene=SCENES, kind=["svg", *MORE_FORMATS]),
        rules.fig13.output,
        rules.mu_sapp.output,
        rules.draw_slips.output,
    localrule: True


RESULTS.append(rules.scenes.input)
