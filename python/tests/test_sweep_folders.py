"""Sweeps in folders: the same numbers as without one, whoever computed the parts; mistakes are named and nothing is overwritten."""

import hashlib
import pathlib
import pickle
import signal
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
    """The folder of one undisturbed process."""
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
    with pytest.raises(an.Interrupted) as stopped:
        disc.sweep({"phi'": many}, to=5, out=folder, chunk=500)
    kept = stopped.value.result
    assert isinstance(kept, an.SweepFolder) and 0 < kept.progress().parts < kept.parts
    assert not [path for path in folder.iterdir() if path.name.startswith(".tmp-")]
    assert kept["case"].size == kept.progress().cases


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
