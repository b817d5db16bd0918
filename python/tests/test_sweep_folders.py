"""Sweeps in folders: the numbers are those of sweeps in memory, whatever process computed the parts; errors overwrite no files."""

import hashlib
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import anholon as an
import numpy as np
import pytest

SPINS = [round(1 + 0.1 * k, 1) for k in range(60)]


def hashes(folder: pathlib.Path) -> dict[str, str]:
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(folder.iterdir())}


@pytest.fixture(scope="module")
def quiet(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """Returns the folder that one process computed without an interruption."""
    folder = tmp_path_factory.mktemp("sweeps") / "quiet"
    an.load("disc").sweep({"phi'": SPINS}, to=1, out=folder, chunk=7)
    return folder


def test_the_numbers_are_those_of_a_sweep_in_memory(quiet: pathlib.Path, disc: an.Model) -> None:
    memory, folder = disc.sweep({"phi'": SPINS}, to=1), an.open_sweep(quiet)
    assert (folder.cases, folder.parts, folder.chunk, folder.missing) == (60, 9, 7, [])
    for name in memory:
        assert np.array_equal(memory[name], folder[name])
    assert np.array_equal(folder["phi'(0)"], memory.varied["phi'"]) and folder["case"].tolist() == list(range(60))
    assert folder["outcome"].tolist() == memory.outcomes and folder.outcomes == {"finished": 60}
    assert len(folder) == len(folder.to_dict()) and set(folder) == set(folder.to_pandas().columns)


def test_frames_have_the_same_columns(quiet: pathlib.Path) -> None:
    folder = an.open_sweep(quiet)
    pandas, polars, arrow = folder.to_pandas(), folder.to_polars(), folder.to_arrow()
    for name in folder:
        expected = folder[name].tolist()
        assert pandas[name].tolist() == polars[name].to_list() == arrow[name].to_pylist() == expected
    assert list(folder.to_pandas(["theta", "x"]).columns) == ["theta", "x"]


def test_pandas_reads_a_folder_as_one_table(quiet: pathlib.Path) -> None:
    import pandas

    read = pandas.read_parquet(quiet, engine="pyarrow")
    assert read["case"].tolist() == list(range(60)) and read["theta"].tolist() == an.open_sweep(quiet)["theta"].tolist()


def test_an_array_is_over_all_cases_while_parts_are_missing(tmp_path: pathlib.Path, disc: an.Model) -> None:
    for place, times in (("end", []), ("rows", [0.25, 0.5])):
        options: dict[str, Any] = {"to": 1, "at": times, "chunk": 2, "columns": ["outcome", "theta", "steps"]}
        whole = disc.sweep({"phi'": [5, 6, 7, 8, 9]}, out=tmp_path / place, **options)
        expected, steps, rows = whole["theta"], whole["steps"], max(1, len(times))
        lean = expected[3 * rows]
        (tmp_path / place / "part-000000.parquet").unlink()
        assert whole["theta"].shape == expected.shape and np.isnan(whole["theta"][: 2 * rows]).all()
        assert np.array_equal(whole["theta"][2 * rows :], expected[2 * rows :]) and np.array_equal(whole["steps"][2 * rows :], steps[2 * rows :])
        assert whole["case"].tolist() == np.repeat(np.arange(5), rows).tolist()
        assert whole["outcome"].tolist() == [""] * (2 * rows) + ["finished"] * (3 * rows)
        assert whole.where({"theta": (lean, lean)}).tolist() == [3] and whole.where({"outcome": ""}).size == 0
        assert whole.to_dict(["case"])["case"].tolist() == np.repeat([2, 3, 4], rows).tolist()
        for part in (1, 2):
            (tmp_path / place / f"part-00000{part}.parquet").unlink()
        assert np.isnan(whole["theta"]).all() and whole["theta"].size == 5


def test_a_model_travels_to_another_process(disc: an.Model) -> None:
    heavy = pickle.loads(pickle.dumps(disc.with_(m=2)))
    assert heavy.parameters == disc.with_(m=2).parameters and heavy.text == disc.text
    pendulum = an.loads('title="P"\ncoordinates=["x"]\nparticle=[{name="b",mass=1,position=["x",0,0]}]\n')
    assert pickle.loads(pickle.dumps(pendulum)).title == "P"


def test_shares_make_the_same_folder(quiet: pathlib.Path, tmp_path: pathlib.Path, disc: an.Model) -> None:
    folder = tmp_path / "shares"
    for share in (1, 2, 3):
        swept = disc.sweep({"phi'": SPINS}, to=1, out=folder, chunk=7, share=(share, 3))
        assert swept.progress().parts == 3 * share
    assert hashes(folder) == hashes(quiet)


def test_an_opened_folder_goes_on(quiet: pathlib.Path, tmp_path: pathlib.Path, disc: an.Model) -> None:
    folder = tmp_path / "half"
    disc.sweep({"phi'": SPINS}, to=1, out=folder, chunk=7, share=(1, 2))
    assert not an.open_sweep(folder).complete
    assert an.open_sweep(folder).fill(threads=1).complete and hashes(folder) == hashes(quiet)


def test_ctrl_c_keeps_complete_parts(tmp_path: pathlib.Path, disc: an.Model) -> None:
    folder, many = tmp_path / "stopped", np.linspace(1, 7, 100_000)

    def press() -> None:
        while not list(folder.glob("part-*")):
            time.sleep(0.01)
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)

    threading.Thread(target=press, daemon=True).start()
    with pytest.raises(an.Interrupted, match="the same call goes on") as stopped:
        disc.sweep({"phi'": many}, to=5, out=folder, chunk=500)
    kept = stopped.value.result
    assert isinstance(kept, an.SweepFolder) and 0 < kept.progress().parts < kept.parts
    assert not [path for path in folder.iterdir() if path.name.startswith(".tmp-")]
    assert kept.to_dict(["case"])["case"].size == np.isfinite(kept["theta"]).sum() == kept.progress().cases


def test_stop_and_progress(tmp_path: pathlib.Path, disc: an.Model) -> None:
    told: list[float] = []
    swept = disc.sweep(
        {"phi'": np.linspace(1, 7, 100_000)}, to=5, out=tmp_path / "f", chunk=500, stop=lambda: len(told) > 3, progress=lambda done, _: told.append(done)
    )
    assert told == sorted(told) and not swept.complete


def test_another_request_is_refused(quiet: pathlib.Path, disc: an.Model) -> None:
    before = hashes(quiet)
    sweeps: list[tuple[str, Callable[[], Any]]] = [
        ("to is '1' there and '2' here", lambda: disc.sweep({"phi'": SPINS}, to=2, out=quiet)),
        ("tolerance", lambda: disc.sweep({"phi'": SPINS}, to=1, tolerance=1e-9, out=quiet)),
        ("set is not given there and 'm=2' here", lambda: disc.with_(m=2).sweep({"phi'": SPINS}, to=1, out=quiet)),
        ("vary phi' differs", lambda: disc.sweep({"phi'": SPINS[:-1]}, to=1, out=quiet)),
        ("column", lambda: disc.sweep({"phi'": SPINS}, to=1, columns=["x"], out=quiet)),
        ("model", lambda: an.loads(disc.text + "# another text\n").sweep({"phi'": SPINS}, to=1, out=quiet)),
    ]
    for word, sweep in sweeps:
        with pytest.raises(an.ModelError, match="holds another sweep") as refused:
            sweep()
        assert word in str(refused.value)
    assert hashes(quiet) == before


def test_foreign_folders_and_changed_parts_are_named(quiet: pathlib.Path, tmp_path: pathlib.Path, disc: an.Model) -> None:
    (tmp_path / "thesis.tex").write_text("text")
    with pytest.raises(an.ModelError, match="holds other files"):
        disc.sweep({"phi'": SPINS}, to=1, out=tmp_path)
    with pytest.raises(an.ModelError, match="is no folder of a sweep"):
        an.open_sweep(tmp_path)
    folder = tmp_path / "changed"
    disc.sweep({"phi'": SPINS}, to=1, out=folder, chunk=7)
    part = folder / "part-000003.parquet"
    text = bytearray(part.read_bytes())
    text[40] ^= 1
    part.write_bytes(text)
    with pytest.raises(an.ModelError, match="part-000003.parquet: the numbers of the file are not those"):
        an.open_sweep(folder)["theta"]
    part.unlink()
    assert disc.sweep({"phi'": SPINS}, to=1, out=folder).complete and hashes(folder) == hashes(quiet)


GRID: dict[str, list[float]] = {"phi'": [1 + 0.5 * k for k in range(13)], "theta": [0.2 + 0.15 * k for k in range(9)]}


def test_borders_are_refined_whoever_computes(tmp_path: pathlib.Path, disc: an.Model) -> None:
    once = disc.sweep(GRID, to=3, out=tmp_path / "once", chunk=20, refine=2, refine_by=("theta", 0.5))
    assert once.complete and once.generations[0] == 117 and len(once.generations) == 3 and once.cases == sum(once.generations)
    bit_by_bit = disc.sweep(GRID, to=3, out=tmp_path / "bits", chunk=20)
    assert bit_by_bit.generations == [117]
    for number in (1, 2):
        for share in (1, 2):
            bit_by_bit.fill(share=(share, 2), threads=1, refine=number, refine_by=("theta", 0.5))
        bit_by_bit.fill(refine=number, refine_by=("theta", 0.5))
    assert hashes(tmp_path / "bits") == hashes(tmp_path / "once")
    # The grid is halved between neighbours, but not everywhere.
    spins = np.unique(once["phi'(0)"])
    assert np.isclose(np.diff(spins).min(), 0.125) and once.cases < 49 * 33 / 2
    for generations in (3, 2, 1):
        with pytest.raises(an.ModelError, match="was refined by 'theta:0.5'"):
            once.fill(refine=generations, refine_by=("theta", 0.25))
    with pytest.raises(an.ModelError, match="was refined by 'theta:0.5', not by these alone"):
        disc.sweep(GRID, to=3, out=tmp_path / "once", refine=1)
    with pytest.raises(an.ModelError, match="lies no grid"):
        disc.sweep({"m": [1, 3, 2]}, to=1, out=tmp_path / "none", refine=1)


def test_a_generation_that_another_process_planned_is_not_planned_again(tmp_path: pathlib.Path, disc: an.Model) -> None:
    folder = disc.sweep(GRID, to=3, out=tmp_path / "f")
    planned = folder._core.refine("theta:0.5", 1)
    assert planned > 0 and folder._core.refine("theta:0.5", 1) == planned and folder.generations == [117, planned]
    with pytest.raises(an.ModelError, match="generation 3 cannot follow on generation 1"):
        folder._core.refine("theta:0.5", 3)
    with pytest.raises(an.ModelError, match="parts are missing"):
        folder._core.refine("theta:0.5", 2)


def test_a_grid_has_the_cases_of_its_list(tmp_path: pathlib.Path, disc: an.Model) -> None:
    grid = {"phi'": an.grid(1, 7, 13), "theta": an.grid("0.2", "1.4", 9)}
    exact = {"phi'": [str(1 + k / 2) for k in range(13)], "theta": [f"{20 + 15 * k}/100" for k in range(9)]}
    memory, folder = disc.sweep(grid, to=1), disc.sweep(grid, to=1, out=tmp_path / "grid", refine=1, refine_by=("theta", 0.5))
    listed = disc.sweep(exact, to=1, out=tmp_path / "list", refine=1, refine_by=("theta", 0.5))
    assert memory.cases == 117 and np.array_equal(memory["theta"], folder["theta"][:117])
    assert folder.generations == listed.generations and np.array_equal(folder["theta"], listed["theta"])
    with pytest.raises(an.ModelError, match="a range has between 2 and 1000000000 values"):
        disc.sweep({"phi'": an.grid(1, 7, 1)}, to=1)


def test_a_folder_is_judged_once(tmp_path: pathlib.Path, disc: an.Model) -> None:
    folder = disc.sweep({"phi'": SPINS}, to=1, out=tmp_path / "f", chunk=7, share=(1, 2))
    with pytest.raises(an.ModelError, match="4 of 9 parts are missing"):
        folder.judge()
    judged = folder.fill().judge()
    error, residuals = judged["error_estimate"], judged["residuals"]
    assert 10 <= error["digits"] <= 16 and error["compared"] == residuals["checked"] and error["worst_case"] in error["compared"]
    assert 0 <= residuals["newton"]["worst"] < 1e-12 and len(judged["text"]) == 2
    kept = tmp_path / "f" / "_judgement.json"
    before = kept.stat().st_mtime_ns
    assert an.open_sweep(folder.path).judge() == judged and kept.stat().st_mtime_ns == before
    # The estimate bounds the difference of two runs of the worst case.
    case = error["worst_case"]
    sharp = folder.run(case, digits=25, tolerance="1e-24")
    for name in ("x", "theta"):
        assert abs(sharp[name][-1] - folder[name][case]) < 100 * error["error"] * max(1, abs(sharp[name]).max())


def test_refined_by_workers_of_dask(client: Any, tmp_path: pathlib.Path, disc: an.Model) -> None:
    disc.sweep(GRID, to=3, out=tmp_path / "here", chunk=20, refine=2, refine_by=("theta", 0.5))
    disc.sweep(GRID, to=3, out=tmp_path / "there", chunk=20, refine=2, refine_by=("theta", 0.5), on=client)
    assert hashes(tmp_path / "here") == hashes(tmp_path / "there")


def test_chosen_cases_and_their_motions(tmp_path: pathlib.Path, disc: an.Model) -> None:
    folder = disc.with_(m=2).sweep(GRID, to=3, initial={"psi'": 0.1}, out=tmp_path / "f", refine=1, refine_by=("theta", 0.5))
    chosen = folder.where({"outcome": "finished", "phi'(0)": (1.2, 1.3)})
    assert chosen.size > 0 and all(1.2 <= folder["phi'(0)"][case] <= 1.3 for case in chosen)
    for case in (0, int(chosen[0]), folder.cases - 1):
        run = an.open_sweep(folder.path).run(case, every="0.5")
        assert len(run) == 7 and run["phi'"][0] == folder["phi'(0)"][case]
        for name in ("theta", "x", "phi'"):
            # A sweep shares a plan between cases, which changes the last digits; a disc that nearly lies flat amplifies the difference.
            assert np.isclose(run[name][-1], folder[name][case], rtol=1e-7, atol=1e-7)
    assert not np.isclose(folder.run(0)["theta"][-1], folder["theta"][1])
    with pytest.raises(IndexError, match="cases"):
        folder.run(10**9)
    with pytest.raises(KeyError, match="there is no column 'lean'"):
        folder.where({"lean": 1})


def test_a_motion_follows_from_what_the_folder_keeps(tmp_path: pathlib.Path, disc: an.Model, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = disc.sweep({"phi'": ["16/3", 6]}, to=1, initial={"t": "1/4", "psi'": "0.1"}, out=tmp_path / "f")

    def computing(path: str) -> Any:
        raise AssertionError("the equations of the sweep are not needed")

    with monkeypatch.context() as patched:
        patched.setattr("anholon._sweep_filling.computing", computing)
        for opened in (folder, an.open_sweep(folder.path)):
            run = opened.run(0)
            assert (run.t[0], run.t[-1], run["phi'"][0], run["psi'"][0]) == (0.25, 1, 16 / 3, 0.1)
            assert np.isclose(run["theta"][-1], folder["theta"][0], rtol=1e-9)
            assert opened.run(1, at=["1/2", 1]).t.tolist() == [0.5, 1]


def test_a_motion_of_a_case_whose_numbers_are_not_kept(tmp_path: pathlib.Path, disc: an.Model) -> None:
    folder = disc.sweep({"phi'": ["16/3", 6]}, to=1, out=tmp_path / "f")
    (tmp_path / "f" / "part-000000.parquet").unlink()
    assert an.open_sweep(folder.path).run(0)["phi'"][0] == folder.run(0)["phi'"][0] == 16 / 3


def test_columns_leave_out_neither_what_varies_nor_reductions(tmp_path: pathlib.Path, disc: an.Model, program: Callable[..., str]) -> None:
    asked: dict[str, Any] = {"to": 1, "reduce": ["max(theta')", "min(theta)"], "columns": ["theta", "outcome", "min*", "x"]}
    folder = disc.sweep({"phi'": [5, 6], "m": [1, 2]}, **asked, out=tmp_path / "f")
    names = ["case", "phi'(0)", "m", "theta", "outcome", "min(theta)", "x", "max(theta')"]
    assert list(folder) == list(folder.to_pandas()) == names and folder.varied == ["phi'(0)", "m"]
    words = ["--vary", "phi'=5,6", "--vary", "m=1,2", "--to", "1", "--reduce", "max(theta'),min(theta)", "--columns", "theta,outcome,min*,x", "--quiet"]
    assert program("sweep", "disc", *words) == program("sweep", "collect", folder.path, "--quiet")
    memory = disc.sweep({"phi'": [5, 6], "m": [1, 2]}, **{**asked, "columns": ["theta"]})
    assert list(memory) == ["theta", "max(theta')", "min(theta)"]
    np.testing.assert_array_equal(memory["max(theta')"], folder["max(theta')"])
    saved = memory.save(tmp_path / "s.csv")
    assert pathlib.Path(saved).read_text().splitlines()[0] == "case,phi'(0),m,outcome,t,theta,max(theta'),min(theta)"


def test_a_sweep_that_cannot_be_refined_is_refused_before_it_is_computed(tmp_path: pathlib.Path, disc: an.Model) -> None:
    vary = {"phi'": an.grid(1, 7, 7)}
    for options, message in (
        ({"refine": 1, "columns": ["theta"]}, "without the column 'outcome'"),
        ({"refine": 1, "refine_by": ("tehta", 0.1)}, "did you mean 'theta'"),
    ):
        with pytest.raises(an.ModelError, match=message):
            disc.sweep(vary, to=1, out=tmp_path / "f", **options)  # type: ignore[call-overload]
        assert not (tmp_path / "f").exists()
    folder = disc.sweep(vary, to=1, out=tmp_path / "f", refine=1, columns=["theta", "outcome"], chunk=3)
    part = tmp_path / "f" / "part-000001.parquet"
    part.unlink()
    with pytest.raises(an.ModelError, match="keeps no column 'x'"):
        an.open_sweep(folder.path).fill(refine=1, refine_by=("x", 0.1))
    assert not part.exists()


def test_motions_of_a_folder_of_the_command_line(tmp_path: pathlib.Path) -> None:
    words = ["--vary", "phi'=1:7:7", "--set", "m=2", "--qdot", "psi=0.1", "--to", "3", "--quiet", "-o", str(tmp_path / "f") + "/"]
    subprocess.run([os.environ["ANHOLON_PROGRAM"], "sweep", "disc", *words], check=True)
    folder = an.open_sweep(tmp_path / "f")
    for case in (0, 6):
        assert np.isclose(folder.run(case)["theta"][-1], folder["theta"][case], rtol=1e-10)
    assert folder.run(0).model.parameters["m"] == 2


def test_a_folder_keeps_the_files_of_its_model(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The folder is enough to compute the motion of a case and missing parts, from any working folder."""
    place = tmp_path / "models"
    place.mkdir()
    (place / "thrust.csv").write_text("0,1\n3,2\n6,-1\n")
    (place / "below.toml").write_text(
        'coordinates = ["x"]\nparameters.k = 1\nparticle = [{name = "p", mass = 1, position = "x*ex"}]\n'
        'table = [{name = "f", file = "thrust.csv"}]\nforce = [{on = "p", vector = "(f(t) - k*x)*ex"}]\ninitial.x = 1\n'
    )
    (place / "cart.toml").write_text('base = "below.toml"\ninitial.x = 2\n')
    monkeypatch.chdir(place)
    made = an.load("cart.toml").sweep({"k": [1, 2, 3]}, to=6, out=tmp_path / "f", chunk=1)
    expected, before = made["x"].tolist(), hashes(tmp_path / "f")
    subprocess.run([sys.executable, "-c", FILLED_ELSEWHERE, str(tmp_path / "f"), str(place)], check=True, cwd=tmp_path)
    assert hashes(tmp_path / "f") == before
    assert an.open_sweep(tmp_path / "f").run(1)["x"][-1] == pytest.approx(expected[1], rel=1e-9)
    assert an.open_sweep(tmp_path / "f").run(1).model.with_(k=3).simulate(to=6)["x"][-1] == pytest.approx(expected[2], rel=1e-9)


FILLED_ELSEWHERE = """
import os, shutil, sys
import anholon as an
shutil.rmtree(sys.argv[2])
os.remove(sys.argv[1] + "/part-000001.parquet")
assert an.open_sweep(os.path.relpath(sys.argv[1])).fill().missing == []
"""


def test_motions_of_scenarios_of_the_command_line(tmp_path: pathlib.Path) -> None:
    model = tmp_path / "spring.toml"
    model.write_text(
        """coordinates = ["x"]
parameters = {m = 1, k = 4}
particle = [{name = "P", mass = "m", position = "x*ex"}]
potential.spring = "k*x^2/2"
initial = {x = 1, "x'" = 0}
simulate = {to = 2}
[case.stiff]
parameters = {k = 400}
[case."a b"]
initial = {x = 3}
"""
    )
    out = str(tmp_path / "f") + "/"
    words = ["--vary", "case=stiff,a b", "--vary", "m=1,2", "--t", "0.5", "--method", "rk", "--tolerance", "1e-9", "--quiet", "-o", out]
    subprocess.run([os.environ["ANHOLON_PROGRAM"], "sweep", str(model), *words], check=True)
    folder = an.open_sweep(out)
    for case in range(4):
        run = folder.run(case)
        assert run["t"][0] == 0.5
        assert run.report.method == "rk"
        assert np.isclose(run["x"][-1], folder["x"][case], rtol=1e-8)
        assert not np.isclose(run["x"][-1], folder["x"][(case + 1) % 4], rtol=1e-4)
    with pytest.raises(IndexError, match="there are 4 cases"):
        folder.run(4)


FAMILY = """coordinates = ["q[i,j]"]
parameters = {"k[i,j]" = [1, 2, 3, 4]}
index = {i = "1..2", j = "1..2"}
[[particle]]
name = "p[i,j]"
mass = 1
position = "q[i,j]*ex"
[[force]]
on = "p[i,j]"
vector = "-k[i,j]*q[i,j]*ex"
[initial]
"q[i,j]" = 1
[case."heavy, big"]
parameters = {"k[1,1]" = 5}
[case.light]
"""


def test_names_with_commas(tmp_path: pathlib.Path) -> None:
    model = tmp_path / "family.toml"
    model.write_text(FAMILY)
    out = str(tmp_path / "f") + "/"
    words = ["--vary", "k[1,2]=2,3", "--vary", "q[2,1]=1,2", "--to", "1", "--quiet", "-o", out]
    subprocess.run([os.environ["ANHOLON_PROGRAM"], "sweep", str(model), *words], check=True)
    folder = an.open_sweep(out)
    for case in range(4):
        assert np.isclose(folder.run(case)["q[2,1]"][-1], folder["q[2,1]"][case], rtol=1e-8)
        assert np.isclose(folder.run(case)["q[1,2]"][-1], folder["q[1,2]"][case], rtol=1e-8)
    ours = an.load(model).sweep({"case": ["light", "heavy, big"], "q[1,1]": [1, 2]}, to=1, out=tmp_path / "g")
    assert np.isclose(an.open_sweep(ours.path).run(2)["q[1,1]"][-1], ours["q[1,1]"][2], rtol=1e-8)
    assert not np.isclose(ours["q[1,1]"][2], ours["q[1,1]"][0], rtol=1e-3)


def test_a_lazy_frame_reads_what_is_asked(quiet: pathlib.Path) -> None:
    polars = pytest.importorskip("polars")
    folder = an.open_sweep(quiet)
    some = folder.scan().filter(polars.col("case") > 50).select("theta").collect()
    assert some["theta"].to_list() == folder["theta"][51:].tolist()


def test_arguments_without_a_folder(disc: an.Model) -> None:
    with pytest.raises(an.ModelError, match="belong to a sweep in a folder"):
        disc.sweep({"phi'": SPINS}, to=1, share=(1, 2))  # type: ignore[call-overload]
    with pytest.raises(KeyError, match="there is no column 'lean'"):
        disc.sweep({"phi'": SPINS}, to=1)["lean"]


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, distributed.Client(cluster) as client:
        yield client


def test_workers_of_dask_make_the_same_folder(client: Any, quiet: pathlib.Path, tmp_path: pathlib.Path, disc: an.Model) -> None:
    swept = disc.sweep({"phi'": SPINS}, to=1, out=tmp_path / "workers", chunk=7, on=client)
    assert swept.complete and hashes(tmp_path / "workers") == hashes(quiet)
    again = disc.sweep({"phi'": SPINS}, to=1, out=tmp_path / "address", chunk=7, on=client.scheduler.address)
    assert again.complete and hashes(tmp_path / "address") == hashes(quiet)


def test_a_scheduler_that_does_not_answer_is_named(tmp_path: pathlib.Path, disc: an.Model) -> None:
    dask = pytest.importorskip("dask")
    pytest.importorskip("distributed")
    with dask.config.set({"distributed.comm.timeouts.connect": "100ms"}), pytest.raises(OSError, match=r"no scheduler of Dask answers at tcp://127\.0\.0\.1:9") as error:
        disc.sweep({"phi'": SPINS}, to=1, out=tmp_path / "lost", chunk=7, on="tcp://127.0.0.1:9")
    assert "the same call goes on" in str(error.value)
    disc.sweep({"phi'": SPINS}, to=1, out=tmp_path / "lost", chunk=7)


def test_a_part_that_cannot_be_written_ends_the_sweep(client: Any, tmp_path: pathlib.Path, disc: an.Model) -> None:
    folder = tmp_path / "changed"
    disc.sweep({"phi'": SPINS}, to=1, out=folder, chunk=7, share=(1, 9))
    (folder / "part-000005.parquet").mkdir()
    (folder / "part-000005.parquet" / "file").write_text("in the way")
    before = hashes(folder / "part-000005.parquet")
    swept = disc.sweep({"phi'": SPINS}, to=1, out=folder, on=client)
    with pytest.raises(an.ModelError, match="part-000005"):
        swept.progress()
    assert hashes(folder / "part-000005.parquet") == before


def test_a_process_that_fills_a_folder_ends_without_a_word(tmp_path: pathlib.Path) -> None:
    script = "import numpy, anholon as an\nan.load('disc').sweep({\"phi'\": [5, 6]}, to=1, out='falls')"
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_the_run_of_a_case_has_the_value_in_the_unit_of_the_file(tmp_path: pathlib.Path) -> None:
    model = an.loads("""coordinates = ["th"]
parameters = {l = {value = 50, unit = "cm"}}
particle = [{name = "bob", mass = "2 kg", position = "l*sin(th)*ex - l*cos(th)*ez"}]
gravity.field = "-(9.81 m/s^2)*ez"
initial = {th = "10 deg"}
""")
    assert model.with_(l=25).parameters["l"] == 25
    folder = model.sweep({"l": [25, "1/3*(1 m)", "0.5 m"]}, to=0.1, out=tmp_path / "lengths")
    assert folder["l"].tolist() == [25, 100 / 3, 50] and folder.units["l"] == "cm"
    assert model.sweep({"l": an.grid(25, 50, 2)}, to=0.1).varied["l"].tolist() == [25, 50]
    for opened in (folder, an.open_sweep(folder.path)):
        for case in range(3):
            assert opened.run(case)["th"][-1] == pytest.approx(opened["th"][case], rel=1e-13)
    values = model.stability("l", 25, 50, 2, about="equilibrium")
    assert values.values.tolist() == [25, 50]


def test_workers_keep_the_units_of_the_file(client: Any, tmp_path: pathlib.Path) -> None:
    model = an.loads("""coordinates = ["th"]
parameters = {l = {value = 50, unit = "cm"}, a = {value = 10, unit = "deg"}}
particle = [{name = "bob", mass = "2 kg", position = "l*sin(th)*ex - l*cos(th)*ez"}]
gravity.field = "-(9.81 m/s^2)*ez"
initial = {th = "a"}
""")
    vary: dict[str, Any] = {"l": [25, "1/3", "2 m"], "a": [10, 30]}
    whole = model.sweep(vary, to=0.3)
    swept = model.sweep(vary, to=0.3, out=tmp_path / "lengths", chunk=2, on=client)
    assert swept.complete and swept["l"].tolist() == whole.varied["l"].tolist() == [25, 25, 1 / 3, 1 / 3, 200, 200]
    assert swept["a"].tolist() == [10, 30] * 3 and swept["th"].tolist() == whole["th"].tolist()


def test_a_motion_that_an_event_ends_shows_the_state_before_it(tmp_path: pathlib.Path) -> None:
    model = an.loads(
        """
coordinates = ["x"]
parameters = {e = 0.5}
particle = [{name = "p", mass = 1, position = "x*ex"}]
gravity.field = "-10*ex"
initial = {x = 0.8}
event = [{name = "hit", when = "x", direction = "down", stop = true, set = {"x'" = "-e*x'"}}]
"""
    )
    model.sweep({"e": ["0.5", "1"]}, to=1, reduce=["last(x')"], out=tmp_path / "falls")
    folder = an.open_sweep(tmp_path / "falls")
    for case in range(2):
        assert folder["x'"][case] == folder["last(x')"][case] == -4
        assert folder.run(case)["x'"][-1] == -4
