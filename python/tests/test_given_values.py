"""Values of NumPy, pandas, polars and pyarrow: dates, single precision, labels, arrays without axes."""

from __future__ import annotations

import datetime
import importlib
import pickle
from collections.abc import Callable
from typing import Any

import anholon as an
import numpy as np
import pytest

pandas = pytest.importorskip("pandas")

_DATES: list[Any] = [
    np.timedelta64(1, "ms"),
    np.timedelta64(1, "ns"),
    np.array([1, 2], "m8[s]"),
    np.array(["1970-01-01T00:00:01"], "M8[s]"),
    np.datetime64("1970-01-01"),
    pandas.to_timedelta([1], unit="s"),
    pandas.Timedelta(1, "s"),
    datetime.timedelta(seconds=1),
]


@pytest.mark.parametrize("t", [*_DATES, True, [True], 1j], ids=repr)
def test_a_run_is_called_with_numbers(disc: an.Model, t: Any) -> None:
    run = disc.simulate(to=2, dense=True)
    with pytest.raises(an.ModelError, match=r"run\(t\) takes times in seconds"):
        run(t)


@pytest.mark.parametrize("t", _DATES, ids=repr)
def test_dates_and_durations_are_no_numbers(disc: an.Model, t: Any) -> None:
    with pytest.raises(TypeError, match="a number is an int, float"):
        disc.simulate(at=t)
    with pytest.raises(TypeError, match="m: a number is an int, float"):
        disc.sweep({"m": t}, to=1)
    f = disc.dynamics()
    with pytest.raises(TypeError, match="t is a number"):
        f(t, f.start)
    if np.ndim(t) == 0:
        with pytest.raises(TypeError, match="theta is a number"):
            f.state(q={"theta": t}, qdot={})


def test_an_array_of_no_axes_is_a_number(disc: an.Model) -> None:
    assert disc.sweep({"m": np.array(2.0)}, to=1).varied["m"].tolist() == [2]
    assert disc.simulate(at=np.array(0.5)).t.tolist() == [0.5]
    f = disc.dynamics()
    half: Any = np.array(0.5)
    np.testing.assert_array_equal(f(half, f.start), f(0.5, f.start))


def test_times_are_in_order_and_once(disc: an.Model) -> None:
    times = [0.3, 0.1, 0.2, 0.1]
    run, sweep = disc.simulate(at=times), disc.sweep({"m": [1]}, at=times)
    assert run.t.tolist() == sweep.times.tolist() == [0.1, 0.2, 0.3]
    np.testing.assert_allclose(run["theta"], sweep.rows("theta")[0], rtol=1e-12)


def test_single_precision_stands_for_its_decimal(disc: an.Model) -> None:
    short = np.array([0.1, 1.1], np.float32)
    tables: list[Any] = [{"m": short}, {"m": list(short)}, pandas.DataFrame({"m": short})]
    makers: list[tuple[str, Callable[[Any], Any]]] = [("polars", lambda m: m.DataFrame({"m": short})), ("pyarrow", lambda m: m.table({"m": short}))]
    for name, make in makers:
        try:
            tables.append(make(importlib.import_module(name)))
        except ImportError:
            continue
    for table in tables:
        assert disc.sweep(cases=table, to=0.1).varied["m"].tolist() == [0.1, 1.1], type(table)
    assert disc.sweep({"m": short}, to=0.1).varied["m"].tolist() == [0.1, 1.1]
    assert disc.sweep({"m": pandas.Series(short)}, to=0.1).varied["m"].tolist() == [0.1, 1.1]
    assert disc.with_(m=short[0]).parameters["m"] == 0.1
    builder = an.Builder("one")
    builder.parameter("m", short[0])
    assert "0.1" in builder.text and "0.100" not in builder.text


def test_two_columns_of_one_name_are_refused(disc: an.Model) -> None:
    table = pandas.DataFrame([[1.2, 1.3]], columns=["theta", "theta"])
    with pytest.raises(an.ModelError, match="two columns of the table have the name 'theta'"):
        disc.sweep(cases=table, to=0.1)
    with pytest.raises(an.ModelError, match="'theta' is given twice in what varies"):
        disc.sweep(table, to=0.1, together=True)
    pyarrow = pytest.importorskip("pyarrow")
    with pytest.raises(an.ModelError, match="two columns of the table have the name 'theta'"):
        disc.sweep(cases=pyarrow.table([[1.2], [1.3]], names=["theta", "theta"]), to=0.1)


def test_labels_of_a_series_are_names() -> None:
    f = an.load("trailers").dynamics(inputs=True)
    p = np.array(f.p0) * np.linspace(1, 1.5, len(f.p0))
    u, x = [0.3, 0.2], f.start + 0.1
    expected = f(0, x, u, p)
    turned = pandas.Series(p, index=f.parameters)[::-1]
    np.testing.assert_array_equal(f(0, x, u, turned), expected)
    np.testing.assert_array_equal(f(0, x, pandas.Series(u, index=f.inputs)[::-1], p), expected)
    np.testing.assert_array_equal(f.jac(0, x, u, turned), f.jac(0, x, u, p))
    np.testing.assert_array_equal(f(0, x, u, pandas.Series(p)), expected)
    part = turned[:2]
    np.testing.assert_array_equal(f(0, x, u, part), f(0, x, u, part.to_dict()))
    np.testing.assert_array_equal(f(0, x, part.iloc[:0].to_dict(), p), f(0, x, {}, p))
    with pytest.raises(KeyError, match="there is no 'absent' in p"):
        f(0, x, u, pandas.Series([1.0], index=["absent"]))
    with pytest.raises(ValueError, match=f"two values have the label '{f.parameters[0]}'"):
        f(0, x, u, pandas.Series([1.0, 2.0], index=[f.parameters[0]] * 2))
    polars = pytest.importorskip("polars")
    np.testing.assert_array_equal(f(0, x, u, polars.Series(p)), expected)


def test_states_by_name_need_no_order() -> None:
    f = an.load("disc").dynamics()
    x = f.start + np.linspace(0.1, 0.2, len(f.start))
    names = [state.name for state in f.states]
    turned = pandas.Series(x, index=names)[::-1]
    np.testing.assert_array_equal(f(0, turned), f(0, x))
    np.testing.assert_array_equal(f(0, turned.to_dict()), f(0, x))
    np.testing.assert_array_equal(f.jac(0, turned), f.jac(0, x))
    assert f.motion(turned) == f.motion(x)
    many = pandas.DataFrame(np.outer(x, [1, 1.5]), index=names)[::-1]
    np.testing.assert_array_equal(f(0, many), f(0, np.outer(x, [1, 1.5])))
    np.testing.assert_array_equal(f(0, pandas.Series(x)), f(0, x))
    with pytest.raises(KeyError, match=f"x has no value of {names[-1]!r}; by name it has all states: {names[0]}, "):
        f(0, turned[1:])
    with pytest.raises(KeyError, match="there is no 'absent' in x"):
        f(0, {**turned.to_dict(), "absent": 1.0})


def test_states_of_other_parameters() -> None:
    model = an.load("sleigh-with-moving-mass")
    f, heavy = model.dynamics(), model.with_(m=3).dynamics()
    speeds = {"x'": np.cos(0.4), "y'": np.sin(0.4), "th'": 1.0}
    own, x = heavy.state(0.3, q={"th": 0.4}, qdot=speeds), f.state(0.3, q={"th": 0.4}, qdot=speeds, p={"m": 3})
    np.testing.assert_array_equal(x, own)
    assert x[-1] != f.state(0.3, q={"th": 0.4}, qdot=speeds)[-1]
    array = np.where(np.array(f.parameters) == "m", 3, f.p0)
    np.testing.assert_array_equal(f.state(0.3, q={"th": 0.4}, qdot=speeds, p=array), own)
    assert f.motion(x, 0.3, p={"m": 3}) == f.motion(x, 0.3, array) == heavy.motion(x, 0.3)
    assert f.motion(x, 0.3) == pytest.approx(f.motion(x, 0.3, f.p0), rel=1e-14)
    assert f.motion(x, 0.3)["th'"] != pytest.approx(1, rel=0.1)
    with pytest.raises(KeyError, match="there is no 'mm' in p"):
        f.motion(x, p={"mm": 3})
    with pytest.raises(ValueError, match="p has the shape"):
        f.state(q={}, qdot={}, p=[1])


def test_complex_directions_are_refused(disc: an.Model) -> None:
    f = disc.dynamics()
    for product in (f.jvp, f.vjp):
        with pytest.raises(TypeError, match="the vector is an array of numbers"):
            product(0, f.start, np.ones(len(f.start)) * 1j)


def test_functions_states_and_folders_go_to_another_process(disc: an.Model, tmp_path: Any) -> None:
    f = an.load("trailers").dynamics(inputs=["steer"], outputs={"twice": "2*steer"}, initial={"x": 1})
    again = pickle.loads(pickle.dumps(f))
    assert again.inputs == f.inputs and again.outputs == f.outputs and again.start.tolist() == f.start.tolist()
    np.testing.assert_array_equal(again(0, f.start, [0.2]), f(0, f.start, [0.2]))
    state = disc.evaluate(initial={"theta": 1.2}, t=1, digits=30)
    assert repr(pickle.loads(pickle.dumps(state))) == repr(state)
    folder = disc.sweep({"m": [1, 2]}, to=0.1, out=tmp_path / "falls")
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(folder))["theta"], folder["theta"])


def test_what_python_calls_otherwise_is_named(disc: an.Model) -> None:
    with pytest.raises(TypeError, match="dense is True or False, not 'no'"):
        disc.simulate(to=1, dense="no")  # type: ignore[arg-type]
    asked: list[Callable[..., object]] = [disc.evaluate, disc.linearize]
    for ask in asked:
        with pytest.raises(an.ModelError, match="digits is a whole number from 1 to 2000, not '30'"):
            ask(digits="30")
    for option, way in (("save", "run.save"), ("continue", "initial="), ("t", 'initial={"t": 1}'), ("inputs", "[input]"), ("rtol", "tolerance=")):
        with pytest.raises(an.ModelError) as refused:
            disc.simulate(to=1, **{option: "run.h5"})  # type: ignore[arg-type]
        assert f"there is no option '{option}'" in str(refused.value) and way in str(refused.value)
    with pytest.raises(an.ModelError, match=r"there is no coordinate 'theta_dot'\nhint: a derivative by time is written with a prime: theta'"):
        disc.simulate(to=1, initial={"theta_dot": 1})
    run = disc.simulate(to=1)
    for key in (slice(1, 2), ["x", "y"], 0):
        with pytest.raises(an.ColumnError, match=r"takes the name of one column"):
            run[key]  # type: ignore[index]
        assert key not in run if not isinstance(key, list) else True
    model = an.loads('coordinates = ["x"]\nparticle = [{name = "p", mass = 1, position = ["x", 0, 0]}]\nstate.z = {rate = "-z", initial = 0.5}\nsimulate.to = 1\n')
    calls: list[Callable[..., object]] = [model.simulate, model.evaluate, model.linearize, model.dynamics]
    for call in calls:
        with pytest.raises(an.ModelError) as refused:
            call(initial={"z": 0.4})
        assert "'z' is a state of the model" in str(refused.value) and "model.with_(z0=0.4)" in str(refused.value)
