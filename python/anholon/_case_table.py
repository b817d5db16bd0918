"""Tables of cases as the text of a CSV file, which is the form that the library takes."""

from __future__ import annotations

import csv
import io
import os
import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Protocol, Union

from . import _core
from ._errors import ModelError
from ._numbers import Number, varied_list


class Frame(Protocol):
    """The method that a table of pandas and a mapping of arrays have in common."""

    def items(self) -> Any:
        """Returns the names with the columns."""


class ArrowTable(Protocol):
    """A table of pyarrow."""

    def to_pydict(self) -> Any:
        """Returns the columns by name."""


class Series(Protocol):
    """A table of polars."""

    def to_dict(self, *, as_series: bool) -> Any:
        """Returns the columns by name."""


CaseTable = Union[str, "os.PathLike[str]", Mapping[str, Iterable[Number]], Frame, ArrowTable, Series]
"""A table of cases: the path of a CSV or Parquet file, arrays by name, or a table of pandas, polars or pyarrow."""


def table_of(cases: CaseTable) -> tuple[str, str]:
    """Returns the name of a table in messages, and the text of the table.

    Raises:
        ModelError: the file cannot be read; the columns have different lengths.
        TypeError: `cases` is no table.
    """
    if isinstance(cases, (str, os.PathLike)):
        return os.fspath(cases), _core.case_table(os.fspath(cases))
    columns: dict[str, list[str]] = {}
    items = list(_items(cases))
    for name, values in items[: len(_without_results([str(name) for name, _ in items]))]:
        if str(name) in columns:
            raise ModelError(f"two columns of the table have the name {str(name)!r}\nhint: one column for each name; rename or drop the other one")
        columns[str(name)] = _texts(name, values)
    if not columns:
        raise ModelError("the table of cases has no columns\nhint: cases={'m': [1, 2], \"x'\": [0, 0.5]}")
    lengths = {len(values) for values in columns.values()}
    if len(lengths) > 1:
        raise ModelError(f"the columns of the table have between {min(lengths)} and {max(lengths)} rows\nhint: as many values of each name")
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(zip(*columns.values()))
    return "the table", text.getvalue()


def names_of_table(text: str) -> set[str]:
    """Returns the names that a table varies. Commas within brackets or quotes do not separate names."""
    heads = [line for line in text.splitlines() if line.strip(" \t")][:1]
    found = re.findall(r'"((?:[^"]|"")*)"|((?:[^,"\[(]|\[[^\]]*\]|\([^)]*\))+)', heads[0] if heads else "")
    names = [(quoted or plain).strip(" \t") for quoted, plain in found]
    return {name.removesuffix("(0)") for name in _without_results(names)}


def _without_results(names: list[str]) -> list[str]:
    """Returns the names of columns without those of results, which follow in the table of a sweep what varies."""
    return names[: names.index("outcome")] if "outcome" in names else names


def lines_of(text: str) -> int:
    """Returns the number of cases of a table."""
    return max(sum(1 for line in text.splitlines() if line.strip(" \t")) - 1, 0)


def _items(cases: Any) -> Iterable[tuple[Any, Any]]:
    if hasattr(cases, "to_pydict"):
        # to_pydict() would lose one of two columns with the same name.
        return [(name, _single(column, column.type, column.to_pylist)) for name, column in zip(cases.column_names, cases.columns)]
    if hasattr(cases, "get_columns") and hasattr(cases, "to_dict"):
        return [(column.name, _single(column, column.dtype, column.to_list)) for column in cases.get_columns()]
    if hasattr(cases, "items"):
        return cases.items()  # type: ignore[no-any-return]
    raise TypeError(f"cases is a number, a table, or the path of one, not a {type(cases).__name__}")


def _single(column: Any, kind: object, values: Callable[[], Any]) -> Any:
    """Returns the values of a column. Those of single precision stay an array, because its numbers have shorter decimals than floats."""
    return column.to_numpy() if str(kind) in ("Float32", "float", "halffloat") else values()


def _texts(name: object, values: Any) -> list[str]:
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise TypeError(f"{name}: a column of a table is a list or an array, not {values!r:.40}")
    texts = varied_list(name, values)
    if any("\n" in text or "\r" in text for text in texts):
        raise ModelError(f"{name}: a number has no line ends")
    return texts
