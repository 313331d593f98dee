"""A loading head, viscosity and interface springs: in the same solver, as exact as without."""

from itertools import pairwise

import numpy as np
import pytest
from chains import SLIDER, first_transitions
from reference import EXTENDED, read_extended
from scipy.linalg import expm

from precursors import Chain, Run, find_slips, simulate, simulate_many
from precursors.accuracy.audit import audit
from precursors.accuracy.proof import ExactChain
from precursors.methods import METHODS
from precursors.model.statics import loads_at_rest, maximal_compressions

SCENES = [(addition, name) for addition, scenes in EXTENDED.items() for name in scenes]
# Of transitions and their loads, [s] and [N]: measured are 3e-14 s and 3e-12 N at most.
TIME, LOAD = 3e-13, 3e-11
# 586 transitions with a heavy head multiply the rounding of the parameters: measured are 6e-12 s and 6e-9 N.
GROWN = 1000.0
# Of a force and of a velocity judged by a matrix exponential, relative to the largest there are: measured are
# 1e-12 at most, as roundings of positions are multiplied by stiffnesses.
JUDGED = 1e-10
# Of an energy balance, relative to the largest energy: measured are 1e-13 at most.
ENERGY = 1e-11
SAMPLES = 5  # times between two transitions at which the rules are checked
ADDITIONS = {"viscosity": 30.0, "interface_stiffness": 3e8, "head_mass": 0.02}


def scene_chain(scene) -> Chain:
    """The chain of an extended scene, each number rounded once."""
    numbers = {name: float(x) for name, x in (scene.slider | scene.additions).items() if name != "theta"}
    numbers["n_blocks"] = int(numbers.get("n_blocks", 10))
    return SLIDER(theta=scene.slider.get("theta", "0"), **numbers)


def columns(transitions) -> tuple[np.ndarray, np.ndarray, list[tuple[int, int]]]:
    """Times, loads and (block, mode) of reference transitions."""
    times, loads = np.array([[float(t.time), float(t.tangential_load)] for t in transitions]).T
    return times, loads, [(t.block, t.mode) for t in transitions]


def order(run: Run) -> list[tuple[int, int]]:
    return list(zip(run.transitions["block"].tolist(), run.transitions["mode"].tolist(), strict=True))


class Judge:
    """Motion by matrix exponentials, with the rules of docs/models.md; the solver's code is not used.

    The state is (omega x, v, p / (m omega), omega V t, 1) with time in 1/omega.
    """

    def __init__(self, run: Run) -> None:
        self.run, self.chain = run, (chain := run.chain)
        n = self.n = chain.n_blocks
        self.omega = np.sqrt(chain.springs.max() / chain.mass)
        unit = chain.mass * self.omega
        mass = chain.mass + np.append(chain.head_mass, np.zeros(n - 1))
        self.share = (chain.mass / mass)[:, None]
        # Rows of G_i / (m omega): springs, then dashpots.
        self.net = np.zeros((n, 3 * n + 2))
        for i in range(n):
            self.pair(i, i - 1, chain.springs[i] / (unit * self.omega), chain.viscosity / unit)
            if i + 1 < n:
                self.pair(i, i + 1, chain.springs[i + 1] / (unit * self.omega), chain.viscosity / unit)
        self.stiffness = chain.interface_stiffness / (unit * self.omega)
        self.strength, self.friction = chain.strength / unit, chain.kinetic_friction / unit
        self.state = np.concatenate(
            [run.start_positions * self.omega, run.start_velocities, np.zeros(n), [0.0, 1.0]]
        )
        self.modes = np.zeros(n, int)
        self.state[2 * n : 3 * n] = self.net @ self.state
        self.worst = 0.0

    def pair(self, i: int, j: int, spring: float, dashpot: float) -> None:
        """Join block i to its neighbour j, -1 being the drive, which has no dashpot."""
        self.net[i, i] -= spring
        self.net[i, 3 * self.n if j < 0 else j] += spring
        if j >= 0:
            self.net[i, self.n + i] -= dashpot
            self.net[i, self.n + j] += dashpot

    def rate(self) -> np.ndarray:
        n, rate = self.n, np.zeros((3 * self.n + 2, 3 * self.n + 2))
        rate[3 * n, -1] = self.chain.drive_velocity
        for i, mode in enumerate(self.modes):
            if mode or self.stiffness:
                rate[i, n + i] = 1.0
                rate[n + i] = self.net[i]
                rate[n + i, -1] -= mode * self.friction[i]
                if mode == 0:
                    rate[n + i, 2 * n + i] = -1.0
                    rate[2 * n + i, n + i] = self.stiffness
        rate[n : 2 * n] *= self.share
        return rate

    def held(self) -> np.ndarray:
        """Force of the interface on each block that sticks."""
        return self.state[2 * self.n : 3 * self.n] if self.stiffness else self.net @ self.state

    def demand(self, excess: float, scale: float) -> None:
        self.worst = max(self.worst, excess / scale)
        assert excess <= JUDGED * scale

    def follow(self) -> float:
        """Go through all transitions and demand that each is one and the first; return the largest excess."""
        n, elapsed = self.n, 0.0
        for interval, (block, mode) in zip(self.run.intervals, order(self.run), strict=False):
            elapsed += interval
            if elapsed == 0.0:
                self.modes[block - 1] = mode
                continue
            step = expm(self.rate() * (interval * self.omega / SAMPLES))
            for _ in range(SAMPLES):
                self.state = step @ self.state
                speed, force = self.state[n : 2 * n], self.held()
                slides = self.modes != 0
                scale = max(abs(speed).max(), abs(self.net @ self.state).max(), self.strength.max())
                self.demand(max(0.0, -(self.modes * speed).min()), scale)
                self.demand(max(0.0, np.where(slides, 0.0, abs(force) - self.strength).max()), scale)
            i = block - 1
            if self.modes[i]:
                self.demand(abs(speed[i]), scale)
                self.state[n + i] = 0.0
                force = (self.net @ self.state)[i]
                if mode:
                    self.demand(self.strength[i] - force * mode, scale)
                else:
                    self.demand(abs(force) - self.strength[i], scale)
                    self.state[2 * n + i] = force
            else:
                self.demand(abs(force[i] * mode - self.strength[i]), scale)
            self.modes[i] = mode
        return self.worst


@pytest.mark.parametrize(("addition", "name"), SCENES)
def test_every_transition_is_that_of_the_reference(addition, name):
    scene, golden = read_extended(addition)[name]
    times, loads, changes = columns(golden)
    run = simulate(scene_chain(scene), float(scene.duration), until=scene.until)
    assert order(run) == changes
    grown = GROWN if (addition, name) == ("head", "papers_chain") else 1.0
    np.testing.assert_allclose(run.transitions["time"], times, rtol=0, atol=TIME * grown)
    np.testing.assert_allclose(run.transitions["tangential_load"], loads, rtol=0, atol=LOAD * grown)


def test_all_transitions_of_a_long_viscous_chain_are_judged_right():
    # Beyond `kernel.LONG` blocks a transition renews its neighbourhood only.
    chain = SLIDER(36, theta=0.4, viscosity=17.3, head_mass=0.001, drive_velocity=0.05)
    speeds = 0.05 * np.sin(np.arange(36.0))
    run = first_transitions(chain, 90, duration=1.0, start_velocities=speeds)
    assert len(run.transitions) == 90
    assert Judge(run).follow() > 0.0


@pytest.mark.parametrize("n_blocks", [2, 7, 13])
def test_all_additions_together_are_judged_right_from_any_start(n_blocks):
    random = np.random.default_rng(n_blocks)
    chain = Chain(
        weights=random.uniform(0.0, 80.0, n_blocks),
        mass=0.0012,
        stiffness=2.5e7,
        drive_stiffness=8e5,
        drive_velocity=0.03,
        mu_s=0.7,
        mu_k=0.3,
        viscosity=random.uniform(1.0, 300.0),
        interface_stiffness=3e7,
        head_mass=0.002,
    )
    start = {"start_velocities": 0.1 * random.standard_normal(n_blocks)}
    run = first_transitions(chain, 60, duration=0.05, **start)
    assert len(run.transitions) > 20
    Judge(run).follow()


def test_the_judge_refuses_a_transition_that_is_late():
    run = simulate(SLIDER(3, theta="1/3", drive_velocity=0.02, **ADDITIONS), 0.02)
    intervals = run.intervals.copy()
    intervals[4] += 1e-12
    with pytest.raises(AssertionError):
        Judge(Run(**(vars(run) | {"intervals": intervals}))).follow()


class Ledger:
    """What becomes of the work of the drive, from positions and velocities of a run alone."""

    NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)

    def __init__(self, run: Run) -> None:
        self.run, self.chain = run, run.chain
        self.mass = self.chain.mass + np.append(self.chain.head_mass, np.zeros(self.chain.n_blocks - 1))
        self.dissipated = {"friction": 0.0, "viscosity": 0.0}

    def springs(self, t: float, x: np.ndarray) -> np.ndarray:
        return self.chain.springs * -np.diff(x, prepend=self.chain.drive_velocity * t)

    def net(self, t: float, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        damped = np.append(0.0, self.chain.viscosity * -np.diff(v))
        return -np.diff(self.springs(t, x) + damped, append=0.0)

    def energy(self, t: float, x: np.ndarray, v: np.ndarray, grip: np.ndarray) -> float:
        stored = 0.5 * (self.mass @ v**2 + self.springs(t, x) ** 2 @ (1 / self.chain.springs))
        kappa = self.chain.interface_stiffness
        return float(stored + (0.5 * grip @ grip / kappa if kappa else 0.0))

    def balance(self) -> tuple[float, float]:
        """Largest energy that one interval does not account for, and the largest energy."""
        run, n = self.run, self.chain.n_blocks
        times = np.append(0.0, run.transitions["time"])
        x, v = run.at(times)
        mode, grip = np.zeros(n, int), self.net(0.0, x[0], v[0]) * (self.chain.interface_stiffness > 0)
        wrong, largest = 0.0, 0.0
        for k, (block, new) in enumerate(order(run)):
            before = self.energy(times[k], x[k], v[k], grip)
            sticks, held = mode == 0, self.chain.interface_stiffness > 0
            grip = grip + sticks * self.chain.interface_stiffness * (x[k + 1] - x[k])
            work = (
                self.integrate(times[k], times[k + 1]) if held or mode.any() else self.load(times[k : k + 2])
            )
            slid = float(self.chain.kinetic_friction * mode @ (x[k + 1] - x[k]))
            self.dissipated["friction"] += slid
            after = self.energy(times[k + 1], x[k + 1], v[k + 1], grip)
            wrong, largest = max(wrong, abs(after - before - work + slid)), max(largest, after)
            mode[block - 1] = new
            at = self.net(times[k + 1], x[k + 1], v[k + 1])[block - 1]
            grip[block - 1] = at if held and new == 0 else 0.0
        return wrong, largest

    def load(self, times: np.ndarray) -> float:
        """Work of the drive on a chain at rest."""
        load = self.run.tangential_load(times)
        return float(load.sum() / 2 * np.diff(times)[0] * self.chain.drive_velocity)

    def integrate(self, start: float, end: float) -> float:
        """Work of the drive less what the dashpots take, by Gauss's rule in parts of a period."""
        period = 2 * np.pi * np.sqrt(self.chain.mass / self.chain.springs.max())
        ends = np.linspace(start, end, 2 + int((end - start) / period))
        total = 0.0
        for a, b in pairwise(ends):
            t, weight = (a + b) / 2 + (b - a) / 2 * self.NODES, (b - a) / 2 * self.WEIGHTS
            v = self.run.at(t)[1]
            lost = weight @ (self.chain.viscosity * np.diff(v) ** 2).sum(axis=1)
            self.dissipated["viscosity"] += lost
            total += weight @ self.run.tangential_load(t) * self.chain.drive_velocity - lost
        return float(total)


@pytest.mark.parametrize("added", [*ADDITIONS, "all"])
def test_the_work_of_the_drive_is_stored_or_lost_to_friction_and_viscosity(added):
    additions = ADDITIONS if added == "all" else {added: ADDITIONS[added]}
    chain = SLIDER(4, theta="1/4", drive_velocity=0.2, **additions)
    run = simulate(chain, 0.003)
    ledger = Ledger(run)
    wrong, largest = ledger.balance()
    assert any(slips := find_slips(run)["is_global"])
    assert len(slips) > 1
    assert wrong < ENERGY * largest
    assert ledger.dissipated["friction"] > 0.1 * largest
    assert (ledger.dissipated["viscosity"] > 1e-3 * largest) == (chain.viscosity > 0)


@pytest.mark.parametrize("viscosity", [1e-12, 1e-9, 1e-6])
def test_a_viscosity_that_goes_to_zero_gives_the_papers_chain(viscosity):
    plain = simulate(SLIDER(), until="global slip")
    run = simulate(SLIDER(viscosity=viscosity), until="global slip")
    assert order(run) == order(plain)
    # Measured is 0.024 s for each N s/m.
    bound = TIME + 0.1 * viscosity
    np.testing.assert_allclose(run.transitions["time"], plain.transitions["time"], rtol=0, atol=bound)


def test_a_stiffer_interface_is_nearer_to_a_rigid_one():
    slider = {"n_blocks": 3, "theta": "1/3", "drive_velocity": 0.1, "viscosity": 54.77}
    rigid = simulate(SLIDER(**slider), 0.003)
    distance = []
    for stiffness in (3e9, 3e10, 3e11):
        run = simulate(SLIDER(**slider, interface_stiffness=stiffness), 0.003)
        assert order(run) == order(rigid)
        distance.append(np.abs(run.transitions["time"] - rigid.transitions["time"]).max())
    assert len(rigid.transitions) > 10
    assert distance[2] < distance[1] / 5 < distance[0] / 25


def test_a_block_on_a_spring_swings_about_the_drive_for_tens_of_thousands_of_windows():
    c = SLIDER(1, interface_stiffness=4e8)
    run = simulate(c, 0.5)
    times = np.sort(np.random.default_rng(1).uniform(0.0, 0.5, 200))
    omega = np.sqrt((c.drive_stiffness + c.interface_stiffness) / c.mass)
    follows = c.drive_stiffness * c.drive_velocity / (c.drive_stiffness + c.interface_stiffness)
    positions, velocities = run.at(times)
    assert omega * run.duration > 1e4
    # A position is known to a rounding of a force over a stiffness, a velocity to that times omega.
    grain = np.finfo(float).eps * run.tangential_load([0.5])[0] / c.interface_stiffness * np.sqrt(omega * 0.5)
    expected = follows * (times - np.sin(omega * times) / omega)
    np.testing.assert_allclose(positions[:, 0], expected, rtol=1e-11, atol=10 * grain)
    expected = follows * (1.0 - np.cos(omega * times))
    np.testing.assert_allclose(velocities[:, 0], expected, rtol=0, atol=10 * grain * omega)
    assert (run.at(times[150:])[0] == positions[150:]).all()


@pytest.fixture(scope="module")
def extended() -> Run:
    return simulate(SLIDER(4, theta="1/4", drive_velocity=0.05, **ADDITIONS), 0.01)


def test_states_are_continuous_at_transitions(extended):
    times = extended.transitions["time"]
    nearby = 1e-13
    positions, velocities = extended.at(times)
    earlier_positions, earlier_velocities = extended.at(times - nearby)
    # The drive pushes with up to 280 N: no block is faster than 2 m/s, none has more than 1e6 m/s^2.
    np.testing.assert_allclose(positions, earlier_positions, rtol=0, atol=2.0 * nearby + 1e-17)
    np.testing.assert_allclose(velocities, earlier_velocities, rtol=0, atol=1e6 * nearby)
    assert extended.tangential_load(times) == pytest.approx(extended.transitions["tangential_load"], abs=1e-9)


def test_a_run_with_additions_comes_back_from_its_file(extended, tmp_path):
    extended.save(tmp_path / "run.h5")
    loaded = Run.load(tmp_path / "run.h5")
    times = np.linspace(0.0, 0.01, 50)
    assert loaded.chain == extended.chain
    assert (loaded.transitions == extended.transitions).all()
    assert (loaded.at(times)[0] == extended.at(times)[0]).all()
    assert (loaded.at(times)[1] == extended.at(times)[1]).all()


def test_chains_of_all_kinds_run_side_by_side_as_alone():
    kinds = [{}, *({name: value} for name, value in ADDITIONS.items()), ADDITIONS]
    chains = [SLIDER(n, drive_velocity=0.1, **kind) for n in (3, 30) for kind in kinds]
    for run in simulate_many(chains, 0.002, threads=2):
        alone = simulate(run.chain, 0.002)
        assert (run.transitions == alone.transitions).all()
        assert (run.intervals == alone.intervals).all()
        assert all(
            (a == b).all() and a.shape == b.shape for a, b in zip(run.states, alone.states, strict=True)
        )


def test_a_run_to_the_global_slip_ends_with_it_on_an_interface_that_never_rests():
    chain = SLIDER(4, drive_velocity=0.05, **ADDITIONS)
    run, longer = simulate(chain, until="global slip"), simulate(chain, 0.02)
    n = len(run.transitions)
    assert run.duration == run.transitions["time"][-1] < 0.02
    assert (run.transitions == longer.transitions[:n]).all()
    assert find_slips(run)["is_global"].tolist()[-1]


@pytest.mark.parametrize("name", ADDITIONS)
@pytest.mark.parametrize(
    "use",
    [
        lambda chain: audit(simulate(chain, 1e-3)),
        lambda chain: ExactChain.from_chain(chain),
        loads_at_rest,
        maximal_compressions,
        *(
            lambda chain, method=method: method.solve(chain, 1e-3, method.sweep[0], None)
            for key, method in METHODS.items()
            if key != "exact"
        ),
    ],
)
def test_what_knows_the_papers_chain_only_refuses_any_other(use, name):
    with pytest.raises(ValueError, match=rf"^{name} = .*: allowed is 0 here") as error:
        use(SLIDER(3, **{name: ADDITIONS[name]}))
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", ADDITIONS)
def test_an_addition_is_a_number_that_is_not_negative(name):
    for value in (-1.0, float("nan"), "much"):
        with pytest.raises(ValueError, match=f"^{name} = "):
            SLIDER(**{name: value})
    assert SLIDER(**{name: 1.0}) != SLIDER()


def test_the_stiffness_of_the_interface_is_shared_among_the_blocks():
    assert SLIDER(8, interface_stiffness=4e8).interface_stiffness == 5e7


def test_the_first_release_on_springs_is_where_the_static_load_breaks_the_first_one():
    # docs/models.md has the force on block 1 of a long chain at rest. Ringing adds a part that falls with the
    # drive's velocity: measured are 9.4e-6 at 1e-3 m/s and 9.4e-7 at 1e-4 m/s.
    for velocity, rest in ((1e-3, 2e-5), (1e-4, 2e-6)):
        chain = SLIDER(30, interface_stiffness=7.5e9, viscosity=54.77, drive_velocity=velocity)
        run = first_transitions(chain, 1, duration=10.0)
        k, kappa = chain.stiffness, chain.interface_stiffness
        decay = 1 + kappa / (2 * k) - np.sqrt((1 + kappa / (2 * k)) ** 2 - 1)
        assert order(run) == [(1, 1)]
        load = chain.strength[0] * (kappa + k * (1 - decay)) / kappa
        assert run.transitions["tangential_load"][0] == pytest.approx(load, rel=rest)
