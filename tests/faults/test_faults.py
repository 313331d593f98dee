"""A small share of every fault, and each one that was ever lost under its own name."""

import gzip
import json
import re
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from faults import configuration, damage, hostile, physics
from faults.outcome import Outcome, table
from faults.workspace import Witness, Workspace, jobs
from precursors import Chain, simulate
from precursors.accuracy.proof.certificate import Certificate, CertificateError
from precursors.analysis.slip_table import slip_table
from precursors.model.config_check import check_config, scene_seconds
from precursors.model.config_file import check_config_file
from precursors.reproduction.paper import pages
from precursors.support import files as storage
from precursors.support import tables as table_files
from precursors.support.files import CHECKSUMS, open_checked, write_sealed
from precursors.support.tables import read_table, write_table

ROOT = Path(__file__).parents[2]
GOOD = {"survived", "refused"}
# Not the first ones, which `make test-faults` tries again.
FEW_CHAINS = range(15_000, 15_040)
FEW_CONFIGURATIONS = range(60)
FEW = 0.02


def papers(**changes):
    return hostile.a_copy() | changes


def refusal(config) -> str:
    with pytest.raises(ValueError, match="configuration: ") as error:
        check_config(config, configuration.SCHEMA)
    assert len(str(error.value).splitlines()) == 1
    return str(error.value)


@pytest.mark.parametrize("number", FEW_CHAINS)
def test_a_hostile_chain_moves_as_the_model_does_or_is_refused(number):
    assert physics.judged(number)[1] in GOOD


def test_the_auditor_sees_a_hostile_run_that_is_wrong(monkeypatch):
    """Without this, `survived` would say nothing: one release of each run comes late, by a millionth."""

    def delayed(chain, most, **options):
        run = right(chain, most, **options)
        intervals, times, shift = run.intervals.copy(), run.transitions.copy(), 0.0
        late = np.flatnonzero(intervals[:-1] > 0)
        if late.size:
            shift = 1e-6 * intervals[late[-1]]
            intervals[late[-1]] += shift
            times["time"][late[-1] :] += shift
        return replace(run, intervals=intervals, transitions=times, duration=run.duration + shift)

    right = physics.first_transitions
    numbers = [n for n in range(30) if physics.trial_kind(n) == "slider"]
    assert {physics.judged(n)[1] for n in numbers} == {"survived"}
    monkeypatch.setattr(physics, "first_transitions", delayed)
    assert not any(physics.judged(n)[1] in GOOD for n in numbers)


# Friction is a hundred-thousandth of the spring forces, or K/k a millionth: what is rounding is not a fault.
@pytest.mark.parametrize("number", [327, 477, 1034, 2918, 3787])
def test_roundings_of_large_forces_are_not_taken_for_faults(number):
    assert physics.verdict(physics.trial(number)[1]) == "survived"


@pytest.mark.parametrize("kind", [kind.name for kind in damage.KINDS])
def test_a_damaged_file_is_refused_in_a_sentence_that_names_it(kind):
    outcome = damage.try_kind(kind, FEW)
    assert outcome.tried > 20
    assert not outcome.lost


def test_every_data_file_that_a_rule_makes_is_of_a_kind_that_is_damaged():
    """A new kind of file in results/ has to say how it is read, or that nothing reads it."""
    rules = "".join(path.read_text(encoding="utf-8") for path in ROOT.glob("workflow/rules/*.smk"))
    made = set(re.findall(r'"results/([^"]+\.(?:h5|csv|json|json\.gz))"', rules))
    assert len(made) > 20
    assert {p for p in made if damage.kind_of(p) is None} <= set(damage.NOT_READ)


def test_every_data_file_in_results_is_of_a_kind_that_is_damaged():
    assert not [place for place in damage.data_files(ROOT / "results") if damage.kind_of(place) is None]


def test_a_file_of_a_new_kind_is_not_forgotten(tmp_path):
    for place in ("tables/a.csv", "tables/deep/b.csv", "new/c.h5", "d.json", "runs/.0123.h5", "e.svg"):
        (tmp_path / place).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / place).touch()
    assert damage.data_files(tmp_path) == ["d.json", "new/c.h5", "tables/a.csv", "tables/deep/b.csv"]
    assert [damage.kind_of(place) is None for place in damage.data_files(tmp_path)] == [
        True,
        True,
        False,
        False,
    ]
    assert "add its kind" in damage.try_result("d.json", FEW, tmp_path).lost[0]


# Readers of data files that pass by the checksums, and what they read: nothing that lies in results/.
UNCHECKED = {
    "src/precursors/config_file.py": "the configuration",
    "src/precursors/ensembles/catalogue.py": "a configuration in memory",
    "src/precursors/proof/certificate.py": "certificates, which hold their checksum",
    "src/precursors/storage.py": "what it has checked",
}
RAW_READERS = re.compile(
    r"read_csv\((?!open_checked\(|checked,)|json\.loads?\(|csv\.(?:DictReader|reader)\((?!io\.StringIO\(|file\))"
    r"|h5py\.File\((?!memory|BytesIO\()|np\.(?:load|loadtxt|genfromtxt)\("
)


def test_no_data_file_is_read_but_by_way_of_its_checksum():
    sources = [p for part in ("src", "workflow", "benchmarks") for p in sorted(ROOT.glob(f"{part}/**/*.py"))]
    found = {
        path.relative_to(ROOT).as_posix()
        for path in sources
        if RAW_READERS.search(path.read_text(encoding="utf-8"))
    }
    assert found == UNCHECKED.keys()


@pytest.mark.parametrize(
    "line", ["pd.read_csv(path)", "json.loads(text)", "h5py.File(path)", "np.load(path)"]
)
def test_a_reader_that_passes_by_the_checksums_is_seen(line):
    assert RAW_READERS.search(line)


@pytest.mark.parametrize("kind", ["table.csv", "numbers.csv", "shown.csv", "evidence.csv", "numbers.json"])
def test_a_checksum_that_is_not_compared_is_seen(monkeypatch, kind):
    """Without this, `refused` would say nothing about tables."""
    monkeypatch.setattr(storage, "open_checked", lambda path: BytesIO(Path(path).read_bytes()))
    for module in (table_files, pages):
        monkeypatch.setattr(module, "open_checked", storage.open_checked)
    outcome = damage.try_kind(kind, FEW)
    assert any("a wrong content was read" in line for line in outcome.lost)


def test_a_table_that_was_changed_by_hand_is_refused(tmp_path):
    write_table(slip_table(simulate(Chain.from_slider(), 1.0)), tmp_path / "slips.csv")
    (tmp_path / "slips.csv").write_text((tmp_path / "slips.csv").read_text().replace("28.0", "28.1"))
    with pytest.raises(ValueError, match="not what was written there"):
        read_table(tmp_path / "slips.csv")


def test_a_table_of_someone_else_has_no_checksum_and_is_read(tmp_path):
    (tmp_path / "mine.csv").write_text("a\n1\n")
    assert read_table(tmp_path / "mine.csv")["a"].tolist() == [1]


def test_the_checksum_beside_a_table_is_what_sha256sum_writes(tmp_path):
    write_table(pd.DataFrame({"a": [1.0]}), tmp_path / "a.csv")
    digest, name = (tmp_path / CHECKSUMS / "a.csv.sha256").read_text().split("  ")
    assert name == "a.csv\n"
    assert re.fullmatch("[0-9a-f]{64}", digest)
    assert open_checked(tmp_path / "a.csv").read() == b"a\n1.0\n"


def test_a_sealed_file_that_fails_half_way_leaves_the_old_one(tmp_path):
    path = tmp_path / "x.h5"
    path.write_bytes(b"old")

    def fail():
        with write_sealed(path, "precursors run 0") as memory:
            memory.write(b"new")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert path.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["x.h5"]


def test_a_certificate_that_does_not_decompress_is_refused(tmp_path):
    """zlib.error, which is neither a ValueError nor an OSError, came through."""
    (tmp_path / "c.json.gz").write_bytes(b"\x1f\x8b\x08\x00" + bytes(50))
    with pytest.raises(CertificateError, match=r"c\.json\.gz is not a whole certificate"):
        Certificate.load(tmp_path / "c.json.gz")


def test_a_certificate_of_json_inside_json_without_end_is_refused(tmp_path):
    (tmp_path / "c.json.gz").write_bytes(gzip.compress(b"[" * 100_000))
    with pytest.raises(CertificateError, match=r"c\.json\.gz is not a whole certificate"):
        Certificate.load(tmp_path / "c.json.gz")


@pytest.mark.parametrize("number", FEW_CONFIGURATIONS)
def test_a_hostile_configuration_is_refused_in_one_line_or_runs(number):
    assert configuration.verdict(hostile.configuration(number)) in GOOD


def test_a_configuration_that_holds_itself_is_refused():
    assert "without end" in refusal(yaml.safe_load("&a {chain: *a}"))


def test_a_number_of_a_thousand_digits_is_refused():
    assert "bits" in refusal(papers(duration=10**1000))


def test_loads_too_far_apart_for_a_quotient_are_refused():
    """The straight line through the load cells overflowed."""
    config = papers(load_cells={"spacing": 5e-324})
    assert "scenes.fig1" in refusal(config)


def test_a_key_of_two_lines_is_refused_in_one():
    assert "a b" in refusal(papers(**{"a\nb": 1}))


def test_a_name_without_end_is_shortened():
    assert len(refusal(papers(fig13=["x" * 100_000] * 3))) < 600


FILES = {
    "b: 1\nb: 2\n": "the key 'b' stands twice, in line 2, column 1",
    '{"b": 1, "b": 2}': "the key 'b' stands twice",
    "__use_yte__: true\nb: ?1\n": "__use_yte__ asks Snakemake to evaluate Python in it",
    hostile.laughs("[1]", f"[{', '.join(9 * '*')}]"): "laugh5 holds 125479 values, by aliases of aliases",
    "[" * 100_000: "nested too deeply",
    "{a: " * 100_000: "values inside values without end, in line 1",
    "- " * 100_000: "values inside values without end, in line 1",
    "&a {chain: *a}": "values inside values without end",
    "a: 1\n---\na: 1\n": "another document in line 2",
    "a:\n\tb: 1\n": "cannot start any token in line 2",
    "a: 2026-13-45\n": "month must be in 1..12",
    "a: !!python/name:os.system\n": "could not determine a constructor for the tag",
    "a: !!int ''\n": "a value that is none of its type",
    "a: \0\n": "control characters are not allowed",
    "- 1\n": "needed are keys and values",
    "": "needed are keys and values",
}


@pytest.mark.parametrize("text", FILES, ids=lambda text: repr(text[:20]))
def test_a_file_that_snakemake_would_misread_or_evaluate_is_refused_in_one_line(tmp_path, text):
    """The compiled loader crashed at a hundred thousand brackets, and ten lines held a billion values."""
    (tmp_path / "odd.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=r"configuration: Config file .*odd\.yaml: ") as error:
        check_config_file(tmp_path / "odd.yaml")
    assert FILES[text] in str(error.value)
    assert len(str(error.value).splitlines()) == 1


@pytest.mark.parametrize(
    "text", ["a: 1\n", '{"a": 1}', '{\n\t"a": 1\n}', "\ufeffa: 1\n", "b: &b {x: 1}\na:\n  <<: *b\n  x: 2\n"]
)
def test_plain_files_are_left_to_snakemake(tmp_path, text):
    (tmp_path / "plain.yaml").write_text(text, encoding="utf-8")
    check_config_file(tmp_path / "plain.yaml")
    check_config_file(tmp_path / "absent.yaml")


@pytest.mark.parametrize(
    ("part", "key", "value", "words"),
    [
        ("long_runs", "duration", 1e300, "long_runs.duration would take about"),
        ("horizon", "lyapunov_duration", 1e12, "horizon.lyapunov_duration would take about"),
        ("horizon", "chains", {"slow": {"duration": 1e9}}, "horizon.chains.slow would take about"),
        ("maps", "points", 10**8, "maps.points = 100000000"),
        ("spread", "members", 10**6, "spread.members = 1000000"),
        ("ensembles", "seconds_per_chunk", 1e-300, "ensembles.seconds_per_chunk = 1e-300"),
    ],
)
def test_runs_beside_the_scenes_that_would_not_end_are_refused(part, key, value, words):
    """Snakemake did not come to the end of planning them."""
    config = papers()
    config[part][key] = value
    assert words in refusal(config)


# Expected to take milliseconds, they took minutes: a cross-section in mm^2 and more, a soft chain, dashpots.
@pytest.mark.parametrize(
    ("values", "at_least"),
    [
        ({"cross_section": 2710002.0}, 10.0),
        (
            {
                "youngs_modulus": 1.36e6,
                "drive_velocity": 4.9e-3,
                "drive_stiffness": 11.4e6,
                "duration": 148.0,
            },
            5.0,
        ),
        ({"model": "viscous", "viscosity": 9070.0, "duration": 2.26}, 1.6),
        ({"mu_k": 3e-6}, 3.0),
    ],
)
def test_a_scene_of_another_size_is_expected_to_take_what_it_takes(values, at_least):
    config = papers()
    config["scenes"] = {"odd": {"title": "odd", "theta": 0, **values}}
    assert at_least < scene_seconds(config, "odd") < 1e4


@pytest.mark.parametrize("absurd", [{"n_blocks": 1000, "duration": 1e6}, {"duration": 1e9}])
def test_a_scene_that_would_take_days_is_refused_with_what_to_do(absurd):
    config = papers()
    config["scenes"]["fig10"] |= absurd
    line = refusal(config)
    assert "scenes.fig10 would take about" in line
    assert "longest_run = 3600 s" in line


@pytest.mark.parametrize("blocks", [10**6, 10**18])
def test_a_chain_that_no_memory_holds_is_refused(blocks):
    config = papers()
    config["scenes"]["fig10"]["n_blocks"] = blocks
    assert f"n_blocks = {blocks}: allowed" in refusal(config)


def test_the_user_can_allow_a_long_scene():
    config = papers(longest_run=1e7)
    config["scenes"]["fig10"]["duration"] = 1e9
    check_config(config, configuration.SCHEMA)


def test_the_papers_scenes_are_expected_to_take_milliseconds():
    assert all(1e-4 < scene_seconds(papers(), name) < 0.1 for name in papers()["scenes"])


def test_the_table_counts_what_was_lost():
    outcome = Outcome("cut")
    for verdict in ("survived", "refused", "a wrong content was read"):
        outcome.count(verdict)
    assert re.search(r"cut +3 +1 +1 +1", table([outcome]))
    assert json.dumps(outcome.lost) == '["a wrong content was read"]'


def test_the_witness_sees_a_file_that_is_half_and_forgets_it_not(tmp_path):
    (tmp_path / "results/tables").mkdir(parents=True)
    witness = Witness(Workspace(tmp_path, tmp_path / "out"), {"results/tables/a.csv": b"whole"})
    (tmp_path / "results/tables/.0123456789abcdef.a.csv").write_bytes(b"ha")
    witness.look()
    assert not witness.wrong
    (tmp_path / "results/tables/a.csv").write_bytes(b"ha")
    witness.look()
    (tmp_path / "results/tables/a.csv").write_bytes(b"whole")
    witness.look()
    assert witness.wrong == {"results/tables/a.csv"}


def test_the_jobs_that_were_killed_are_told_from_those_that_are_finished():
    block = "localrule draw:\n    input: a\n    output: {0}.png, {0}.svg\n    log: x\n    jobid: {1}\n"
    text = block.format("b", 7) + block.format("c", 8) + "Finished jobid: 8 (Rule: draw)\n"
    assert jobs(text) == ({"b.png", "c.png"}, {"c.png"})
