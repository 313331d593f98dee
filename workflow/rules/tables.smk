# Every entry of TABLES is a rule: the function of the library, its inputs (a file, or a list or mapping of files), its
# other options, files that it reads also, the tables that it gives if not one of its own name, those beside them that the
# report leaves out, and the seconds that it takes if it is a job for a cluster's queue.

for name, table in TABLES.items():
    files = [
        file
        for each in table.get("inputs", {}).values()
        for file in ([each] if isinstance(each, str) else each.values() if isinstance(each, dict) else each)
    ]
    called = [table["function"], *(READERS[Path(file).suffix] for file in files)]
    shown, beside = table.get("tables", [name]), table.get("beside", [])

    rule:
        name:
            f"tabulate_{name}"
        input:
            files,
            table.get("also", []),
        output:
            [report(f"results/tables/{each}.csv", category="Tables") for each in shown],
            [f"results/tables/{each}.csv" for each in beside],
        log:
            f"results/logs/tabulate_{name}.log",
        localrule: "seconds" not in table
        threads: table.get("threads", 1)
        resources:
            seconds=table.get("seconds", 0),
        params:
            function=table["function"],
            inputs=table.get("inputs", {}),
            options=table.get("options", {}),
            names=[*shown, *beside],
            readers=READERS,
            code=digest("make_tables", *sorted({function.split(":")[0] for function in called})),
        script:
            "../scripts/make_tables.py"
