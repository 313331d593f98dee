rule draw_chain:
    input:
        code=code_of("draw_chain"),
    output:
        png="results/figures/fig09.png",
        svg=report(
            "results/figures/fig09.svg",
            caption="../report/chain.rst",
            category="Reproduction",
            labels={"figure": "fig09: the chain"},
        ),
    log:
        "results/logs/draw_chain.log",
    benchmark:
        "results/benchmarks/draw_chain.tsv"
    threads: 1
    script:
        "../scripts/draw_chain.py"


rule draw_scene:
    input:
        slips="results/tables/{scene}_slips.csv",
        trace="results/tables/{scene}_trace.csv",
        code=code_of("draw_scene"),
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
    benchmark:
        "results/benchmarks/draw_scene/{scene}.tsv"
    threads: 1
    params:
        slider=lambda wildcards: scene_slider(config, wildcards.scene),
        title=lambda wildcards: config["scenes"][wildcards.scene]["title"],
    script:
        "../scripts/draw_scene.py"


rule draw_fig13:
    input:
        slips=collect("results/tables/{scene}_slips.csv", scene=config["fig13"]),
        code=code_of("draw_fig13"),
    output:
        png="results/figures/fig13.png",
        svg=report(
            "results/figures/fig13.svg",
            caption="../report/fig13.rst",
            category="Reproduction",
            labels={"figure": "fig13: propagation length against load"},
        ),
    log:
        "results/logs/draw_fig13.log",
    benchmark:
        "results/benchmarks/draw_fig13.tsv"
    threads: 1
    params:
        sliders=[scene_slider(config, scene) for scene in config["fig13"]],
    script:
        "../scripts/draw_fig13.py"
