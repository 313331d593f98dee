# The scenes of the configuration: every transition, slips, mu_sapp, Figs. 10-13


rule simulate_scene:
    output:
        run="results/runs/{scene}.h5",
        slips=report("results/tables/{scene}_slips.csv", category="Tables"),
        trace="results/tables/{scene}_trace.csv",
    log:
        "results/logs/simulate_scene/{scene}.log",
    params:
        slider=lambda wildcards: scene_slider(config, wildcards.scene),
        duration=lambda wildcards: scene_duration(config, wildcards.scene),
        additions=lambda wildcards: scene_additions(config, wildcards.scene),
        code=digest("simulate_scene"),
    message:
        "{wildcards.scene}: finding every transition"
    script:
        "../scripts/simulate_scene.py"


SLIPS = collect("results/tables/{scene}_slips.csv", scene=FIG13)

TABLES["reproduction"] = Table(
    function="maegawa2010.paper.scene_numbers:reproduction_table",
    message="comparing the scenes with the paper's numbers",
    inputs={"slips": {scene: f"results/tables/{scene}_slips.csv" for scene in SCENES}},
    options={"paper": PAPER_PRINTS},
)

for scene in SCENES:
    FIGURES[scene] = Figure(
        section="reproduction",
        function="precursors.figures.scene:draw",
        shows=config["scenes"][scene]["title"],
        caption="scene",
        tables={
            "slips": f"results/tables/{scene}_slips.csv",
            "trace": f"results/tables/{scene}_trace.csv",
        },
        options={
            "title": f"{scene.replace('fig', 'Fig. ')}: {config['scenes'][scene]['title']}",
            # one key below the last of those of Fig. 13
            "key": scene not in sorted(FIG13)[:-1],
        },
        look=config["figure"],
    )

FIGURES["fig13"] = Figure(
    section="reproduction",
    function="precursors.figures.precursor_lengths:draw",
    shows="lengths of precursors against the load",
    tables={"slips": SLIPS},
    look=config["figure"],
)

# The scene whose slips are shown in slow motion: that in the middle.
SHOWN = FIG13[len(FIG13) // 2]


rule write_wave:
    input:
        run=RUNS[SHOWN],
        slips=f"results/tables/{SHOWN}_slips.csv",
    output:
        report(
            "results/figures/wave.svg",
            caption="../report/wave.rst",
            category="Reproduction",
            labels={"figure": "wave: two precursors and the global slip, in slow motion"},
        ),
    log:
        "results/logs/write_wave.log",
    localrule: True
    params:
        code=digest("write_wave"),
    message:
        f"drawing the first global slip of {SHOWN} in slow motion"
    script:
        "../scripts/write_wave.py"


RESULTS += [
    collect("results/runs/{scene}.h5", scene=SCENES),
    collect("results/tables/{scene}_{kind}.csv", scene=SCENES, kind=["slips", "trace"]),
    "results/figures/wave.svg",
]


rule fig13:
    input:
        collect("results/figures/fig13.{kind}", kind=FORMATS),
    localrule: True


rule mu_sapp:
    input:
        "results/tables/reproduction.csv",
        "results/tables/definitions.csv",
    localrule: True


rule paper_figures:
    input:
        collect("results/figures/{figure}.{kind}", figure=["fig09", *SCENES, "fig13"], kind=FORMATS),
        "results/figures/wave.svg",
    localrule: True
