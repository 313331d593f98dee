"""The cost of a transition has a row for each kind of motion and number of blocks."""

from precursors.accuracy.cost_per_event import measure_cost


def test_the_cost_is_relative_to_ten_blocks_of_the_same_kind():
    table = measure_cost((5, 10, 50), 2, 60, 3, 0.0)
    assert table.groupby("kind")["n_blocks"].apply(list).to_dict() == {
        "natural": [5, 10, 50],
        "driven": [5, 10, 50],
        "front": [50],
    }
    assert (table["seconds_per_transition"] > 0).all()
    assert (table["seconds_per_evaluation"] < table["seconds_per_transition"]).all()
    assert table[table["n_blocks"] == 10]["relative"].tolist() == [1.0, 1.0]
    assert table[table["kind"] != "front"]["transitions"].tolist() == 2 * [60, 60, 150]


def test_a_front_goes_through_all_blocks_and_is_relative_to_the_driven_chain():
    table = measure_cost((10, 50), 2, 60, 3, 0.0).set_index(["kind", "n_blocks"])
    front = table.loc["front", 50]
    assert front["transitions"] > 2 * 50
    assert front["mean_front"] > 0.5
    base = table.loc[("driven", 10), "seconds_per_transition"]
    assert front["relative"] == front["seconds_per_transition"] / base
