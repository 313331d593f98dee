if config["full"] and IS_PAPER_SLIDER:

    rule publish:
        """Write the tables of long studies to paper/tables, with their rule, commit, seed and checksum."""
        input:
            tables=sorted(PUBLISHED),
        output:
            tables=[COMMITTED / Path(path).name for path in sorted(PUBLISHED)],
            provenance=COMMITTED / "provenance.csv",
        log:
            "results/logs/publish.log",
        localrule: True
        params:
            root=str(ROOT),
            origins={Path(path).stem: origin for path, origin in PUBLISHED.items()},
            code=digest("publish"),
        script:
            "../scripts/publish.py"

    rule article:
        """Make all long studies that the article shows, and write their tables to paper/tables."""
        input:
            rules.publish.input,
            rules.publish.output,
        localrule: True
