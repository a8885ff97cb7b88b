"""The C library as Python sees it. Beside `_surfaces` the only module that knows CFFI.

Every call into the library releases the GIL.
"""

from __future__ import annotations

import dataclasses
import operator
import threading
import types
from collections.abc import Callable, Mapping
from typing import Any, NoReturn, TypeVar

import numpy as np

from . import _arrays, _interrupt
from ._arrays import Array
from ._cancel import CancelToken, ending
from ._cancel import check as check_token
from ._errors import ERRORS, BeltramiError, InvalidArgumentError
from ._native import ffi, lib
from ._tables import (
    OF_PRESETS,
    AtlasCertificate,
    AtlasReport,
    Certificate,
    Chart,
    Energy,
    PackingReport,
    Report,
    Stage,
)

Record = TypeVar(
    "Record",
    AtlasCertificate,
    AtlasReport,
    Certificate,
    Chart,
    Energy,
    PackingReport,
    Report,
    Stage,
)
#: Told how far a run has come: a fraction in [0, 1] and a stage. Returns true to cancel.
Hook = Callable[[float, str], bool]

_TYPES = {
    "f4": lib.BELTRAMI_F32,
    "f8": lib.BELTRAMI_F64,
    "i4": lib.BELTRAMI_U32,
    "u4": lib.BELTRAMI_U32,
    "i8": lib.BELTRAMI_U64,
    "u8": lib.BELTRAMI_U64,
}
_KINDS = {
    lib.BELTRAMI_ELEMENT_FACE: "face",
    lib.BELTRAMI_ELEMENT_VERTEX: "vertex",
    lib.BELTRAMI_ELEMENT_CORNER: "corner",
}
#: What takes an option.
RUN, UNWRAP, PACK = lib.BELTRAMI_CALL_RUN, lib.BELTRAMI_CALL_UNWRAP, lib.BELTRAMI_CALL_PACK
BAKE = lib.BELTRAMI_CALL_BAKE


def text(chars: Any) -> str:
    """Return a C string."""
    return str(ffi.string(chars).decode())


def version() -> str:
    """Return the version of the library, such as "0.1.0"."""
    number = lib.beltrami_version()
    return f"{number // 1000000}.{number // 1000 % 1000}.{number % 1000}"


def build_info() -> str:
    """Return one line on the build of the library: version, solver, licence of what it links."""
    return text(lib.beltrami_build_info())


def status_name(status: int) -> str:
    """Return the name of a status, such as "BELTRAMI_OK"."""
    return text(lib.beltrami_status_name(status))


# ---- Statuses -----------------------------------------------------------------------------


def fail(status: int, message: str, element: int, kind: int) -> NoReturn:
    name = status_name(status)
    where = None if element == lib.BELTRAMI_NO_ELEMENT else element
    if not message:
        message = text(lib.beltrami_status_advice(status))
        if where is not None:
            message = f"{_KINDS[kind]} {where}: {message}"
    raise ERRORS.get(name, BeltramiError)(message, status, name, where, _KINDS.get(kind))


def refuse(status: str, message: str) -> NoReturn:
    """Raise what the library raises with a status, by its name."""
    fail(getattr(lib, status), message, lib.BELTRAMI_NO_ELEMENT, lib.BELTRAMI_ELEMENT_NONE)


def name_index(
    error: BeltramiError, face: Callable[[int], Array], indices: Array, count: int, what: str
) -> None:
    """Has the message show the index as it was given, and say if all of them count from 1.

    The library sees negative ones without a sign, and its checks name no index. `face` returns the
    indices of a face.
    """
    if error.status != "BELTRAMI_E_INDEX_OUT_OF_RANGE" or error.element is None:
        return
    index = next(int(index) for index in face(error.element) if not 0 <= index < count)
    message = f"face {error.element} names vertex {index}"
    if index < 0:
        message += ": indices count from 0, not from the end"
    else:
        message += f", but there are {count} {what}: indices count from 0"
        if (indices.min(), indices.max()) == (1, count):
            message += ", these from 1: give faces - 1"
    error.args = (message,)


# ---- Structs ------------------------------------------------------------------------------


def sized(name: str) -> Any:
    struct = ffi.new(name + "*")
    struct.struct_size = ffi.sizeof(name)
    return struct


def _plain(value: Any, annotation: str) -> Any:
    if annotation == "bool":
        return bool(value)
    if annotation == "str":
        return status_name(value) if isinstance(value, int) else text(value)
    if annotation.startswith("tuple[float"):
        return tuple(value)
    if annotation.startswith("tuple"):
        return None if value[0] == lib.BELTRAMI_NO_ELEMENT else tuple(value)
    return None if value == lib.BELTRAMI_NO_ELEMENT else value


def record(struct: Any, cls: type[Record]) -> Record:
    fields = dataclasses.fields(cls)
    return cls(*(_plain(getattr(struct, field.name), str(field.type)) for field in fields))


def buffer(array: Array) -> dict[str, Any]:
    return {
        "data": ffi.cast("void*", array.ctypes.data),
        "stride": _arrays.stride(array),
        "type": _TYPES[array.dtype.str[1:]],
    }


def _mesh(vertices: Array | None, faces: Array, vertex_count: int) -> Any:
    mesh = sized("beltrami_mesh")
    mesh.vertex_count = vertex_count
    mesh.face_count = len(faces)
    if vertices is not None:
        mesh.positions = buffer(vertices)
    mesh.indices = buffer(faces)
    return mesh


_LEAST_WATCHED = 10_000  # faces: what is done with fewer is over before Ctrl-C could end it


def cancellable(mesh: Any, call: Callable[[], int], token: CancelToken | None = None) -> int:
    """Return the status of a `call` on `mesh`, which Ctrl-C and `token` end.

    Raises KeyboardInterrupt, or Cancelled where the token is cancelled already.
    """
    check_token(token)
    if mesh.face_count < _LEAST_WATCHED:
        return call()
    number = ffi.new("int32_t*")
    mesh.cancel = number

    def cancel() -> None:
        number[0] = 1

    try:
        with ending(token, cancel), _interrupt.watched(cancel) as interrupt:
            status = call()
    finally:
        mesh.cancel = ffi.NULL
    if interrupt.came:
        raise KeyboardInterrupt
    return status


# ---- Options ------------------------------------------------------------------------------


@dataclasses.dataclass(frozen=True)
class _Option:
    key: int
    name: str  # the program's: "coarse-faces"
    type: int
    choices: list[str]
    is_switch: bool
    calls: int  # that take it

    def number(self, value: object) -> float:
        """Return what the library wants for a value. Raises TypeError, ValueError."""
        if self.is_switch:
            if not isinstance(value, (bool, np.bool_)):
                raise TypeError(f"{self.name} is {value!r}: give True or False")
            return int(value)
        if self.choices:
            return self._choice(value)
        try:
            if self.type == lib.BELTRAMI_TYPE_FLOAT:
                return float(operator.truediv(value, 1))  # numbers only, no strings
            return operator.index(value)  # type: ignore[arg-type]
        except TypeError:
            kind = "number" if self.type == lib.BELTRAMI_TYPE_FLOAT else "whole number"
            raise TypeError(f"{self.name} is {value!r}: give a {kind}") from None

    def _choice(self, value: object) -> int:
        choices = " or ".join(repr(choice) for choice in self.choices)
        if not isinstance(value, str):
            raise TypeError(f"{self.name} is {value!r}: give {choices}")
        if value not in self.choices:
            raise ValueError(f"{self.name} is {value!r}: give {choices}")
        return self.choices.index(value)

    def plain(self, number: float) -> object:
        """Return what `number` came from, as a plain bool, str, int or float."""
        if self.is_switch:
            return bool(number)
        return self.choices[int(number)] if self.choices else number

    def arguments(self, value: object) -> list[str]:
        """Return the program's arguments for a valid value."""
        flag = f"--{self.name}"
        if self.is_switch and not self.choices:
            return [flag] if value else []
        if self.is_switch:
            return [flag, self.choices[bool(value)]]
        return [flag, str(value)]


def _read_option(key: int) -> _Option | None:
    info = sized("beltrami_option_info")
    if lib.beltrami_option_describe(key, info) != lib.BELTRAMI_OK:
        return None
    choices: list[str] = []
    while choice := lib.beltrami_option_choice(key, len(choices)):
        choices.append(text(choice))
    is_flag = info.type == lib.BELTRAMI_TYPE_INT and (info.minimum, info.maximum) == (0, 1)
    is_switch = is_flag or choices == ["off", "on"]
    return _Option(key, text(info.name), info.type, choices, is_switch, info.calls)


def _read_options() -> dict[str, _Option]:
    options: dict[str, _Option] = {}
    while option := _read_option(len(options)):
        options[option.name.replace("-", "_")] = option
    return options


_OPTIONS = _read_options()


def options_of(call: int) -> dict[str, _Option]:
    """Return the options of RUN, UNWRAP or PACK by keyword."""
    return {name: option for name, option in _OPTIONS.items() if option.calls & call}


def arguments(options: Mapping[str, object]) -> list[str]:
    """Return the arguments of the program for options as `Context.set_options` returned them."""
    return [word for name, value in options.items() for word in _OPTIONS[name].arguments(value)]


# ---- Progress -----------------------------------------------------------------------------


class _Running(threading.local):
    """The hook of the run under way in this thread, and what it raised."""

    hook: Hook | None = None
    raised: BaseException | None = None


_running = _Running()


def _keep(
    _kind: type[BaseException], raised: BaseException, _traceback: types.TracebackType
) -> None:
    """Keep what the hook raised (KeyboardInterrupt, too) until the C call is over."""
    _running.raised = raised


@ffi.def_extern(name="beltrami_python_progress", error=1, onerror=_keep)  # type: ignore[untyped-decorator]
def _progress(_user: Any, fraction: float, stage: Any) -> int:
    hook = _running.hook
    return 1 if hook is not None and hook(fraction, text(stage)) else 0


# ---- Context ------------------------------------------------------------------------------


class Context:
    """A ``beltrami_context``. One thread at a time may call, but `cancel` any."""

    def __init__(self, token: CancelToken | None = None) -> None:
        check_token(token)
        self.token = token  # ends calls while it is here
        out = ffi.new("beltrami_context**")
        status = lib.beltrami_create_(lib.BELTRAMI_ABI, out)
        if status < 0:
            fail(status, "", lib.BELTRAMI_NO_ELEMENT, lib.BELTRAMI_ELEMENT_NONE)
        self._context = ffi.gc(out[0], lib.beltrami_destroy)

    def _check(self, status: int) -> None:
        if status < 0:
            fail(
                status,
                text(lib.beltrami_error_message(self._context)),
                lib.beltrami_error_element(self._context),
                lib.beltrami_error_element_kind(self._context),
            )

    def set_options(self, options: Mapping[str, object], call: int = RUN) -> dict[str, object]:
        """Set options of a call by keyword; return them as plain values.

        None leaves an option to the preset that stands before it. Raises TypeError, ValueError.
        """
        known = options_of(call)
        plain: dict[str, object] = {}
        for name, value in options.items():
            if name not in known:
                raise TypeError(f"there is no option {name!r}: choose from {', '.join(known)}")
            if value is None and name in OF_PRESETS:
                plain[name] = self._option(known[name])
            else:
                plain[name] = self._set_option(known[name], value)
        return plain

    def _option(self, option: _Option) -> object:
        out = ffi.new("double*")
        self._check(lib.beltrami_get_option(self._context, option.key, out))
        value = float(out[0])
        return option.plain(value if option.type == lib.BELTRAMI_TYPE_FLOAT else int(value))

    def _set_option(self, option: _Option, value: object) -> object:
        is_float = option.type == lib.BELTRAMI_TYPE_FLOAT
        set_number = lib.beltrami_set_float if is_float else lib.beltrami_set_int
        try:
            number = option.number(value)
            status = set_number(self._context, option.key, number)
        except OverflowError:  # of numbers that C's types do not hold
            raise InvalidArgumentError(
                f"{value!r} is out of range for the option {option.name}",
                lib.BELTRAMI_E_INVALID_ARGUMENT,
                "BELTRAMI_E_INVALID_ARGUMENT",
            ) from None
        self._check(status)
        return option.plain(number)

    def set_mesh(self, vertices: Array, faces: Array) -> None:
        """Copy and validate a mesh in arrays of `_arrays`. Raises MeshError."""
        try:
            mesh = _mesh(vertices, faces, len(vertices))
            call = lambda: lib.beltrami_set_mesh(self._context, mesh)  # noqa: E731
            self._check(cancellable(mesh, call, self.token))
        except BeltramiError as error:
            name_index(error, faces.__getitem__, faces, len(vertices), "vertices")
            raise

    def estimate_memory(self) -> int:
        """Return the bytes that the next run is estimated to need. Raises InvalidStateError."""
        out = ffi.new("uint64_t*")
        self._check(lib.beltrami_estimate_memory(self._context, out))
        return int(out[0])

    def run(self, hook: Hook) -> str:
        """Flatten the mesh; returns the name of the status. Raises what the hook raises."""
        return self.call(lib.beltrami_run, (), hook)

    def call(self, function: Any, arguments: tuple[Any, ...], hook: Hook) -> str:
        """Call a function that reports progress; returns the name of the status.

        Raises what the hook raises. It is called in this thread, and never left out: where another
        handler than Python's own waits for Ctrl-C, it is there that it runs.
        """
        outer = _running.hook, _running.raised
        try:
            with ending(self.token, self.cancel), _interrupt.watched(self.cancel) as interrupt:
                status, raised = self._call(function, arguments, hook, interrupt)
            if interrupt.came:
                # The request may have come too late for this run: the next one is not meant.
                self._call(function, arguments, lambda _fraction, _stage: True, interrupt)
        finally:
            _running.hook, _running.raised = outer
        if raised is not None:
            raise raised
        if interrupt.came:
            raise KeyboardInterrupt
        self._check(status)
        return status_name(status)

    def _call(
        self,
        function: Any,
        arguments: tuple[Any, ...],
        hook: Hook,
        interrupt: _interrupt.Interrupt,
    ) -> tuple[int, BaseException | None]:
        """Return the status, and what the hook raised."""

        def told(fraction: float, stage: str) -> bool:
            interrupt.in_callback = True
            try:
                return hook(fraction, stage) or interrupt.came
            finally:
                interrupt.in_callback = False

        _running.hook, _running.raised = told, None
        status = function(self._context, *arguments, lib.beltrami_python_progress, ffi.NULL)
        return status, _running.raised

    def cancel(self) -> None:
        """Ask the run under way, or else the next one, to end. From any thread."""
        lib.beltrami_cancel(self._context)

    def _fetch(self, function: Any, struct: str, cls: type[Record]) -> Record:
        out = sized(struct)
        self._check(function(self._context, out))
        return record(out, cls)

    def report(self) -> Report:
        """Return counts, area and cost of the last run."""
        return self._fetch(lib.beltrami_get_result, "beltrami_result", Report)

    def energy(self) -> Energy:
        """Return the energies of the UVs in double precision."""
        return self._fetch(lib.beltrami_get_energy, "beltrami_energy", Energy)

    def certificate(self, dtype: np.dtype[Any]) -> Certificate:
        """Return the verdict on the UVs as `uvs` returns them in that type."""
        function = (
            lib.beltrami_get_float32_certificate
            if dtype == np.float32
            else lib.beltrami_get_certificate
        )
        return self._fetch(function, "beltrami_certificate", Certificate)

    def stages(self) -> tuple[Stage, ...]:
        """Return the stages of the last run in their order."""
        stages = []
        for index in range(lib.beltrami_stage_count(self._context)):
            out = sized("beltrami_stage")
            self._check(lib.beltrami_get_stage(self._context, index, out))
            stages.append(record(out, Stage))
        return tuple(stages)

    def uvs(self, vertex_count: int, dtype: np.dtype[Any]) -> Array:
        """Return an (n, 2) array of UVs, float32 or float64."""
        uv = np.empty((vertex_count, 2), dtype)
        self._fill(lib.beltrami_get_uvs, uv)
        return uv

    def faces(self, like: Array) -> Array:
        """Return the (m, 3) faces that the map speaks of, in the type and number of `like`."""
        faces = np.empty(like.shape, like.dtype)
        self._fill(lib.beltrami_get_faces, faces)
        return faces

    def _fill(self, function: Any, out: Array) -> None:
        room = buffer(out)
        self._check(function(self._context, room["data"], room["type"], room["stride"]))


# ---- Checks without a context -------------------------------------------------------------


def _judge(function: Any, vertices: Array | None, faces: Array, uv: Array, out: Any) -> None:
    """Call a check. Raises BeltramiError where the status says that there is no verdict."""
    mesh = _mesh(vertices, faces, len(uv))
    uvs = ffi.new("beltrami_buffer*", buffer(uv))
    status = cancellable(mesh, lambda: function(mesh, uvs, out))
    if status >= 0:
        return
    try:
        fail(status, "", out.error_element, out.error_element_kind)
    except BeltramiError as error:
        name_index(error, faces.__getitem__, faces, len(uv), "UVs")
        raise


def check(function: str, uv: Array, faces: Array) -> Certificate:
    """Return the verdict of ``beltrami_check_`` `function` on arrays of `_arrays`."""
    out = sized("beltrami_certificate")
    _judge(getattr(lib, f"beltrami_check_{function}"), None, faces, uv, out)
    return record(out, Certificate)


def measure(vertices: Array, faces: Array, uv: Array) -> tuple[Energy, Array]:
    """Return the means, and an (m, 4) array: s1, s2, symmetric Dirichlet and symmetric ARAP."""
    out = sized("beltrami_energy")
    values = np.empty((len(faces), 4))
    mesh, uvs = _mesh(vertices, faces, len(uv)), ffi.new("beltrami_buffer*", buffer(uv))
    status = cancellable(mesh, lambda: lib.beltrami_measure(mesh, uvs, out, ffi.NULL))
    if status >= 0:
        pointer = ffi.cast("double*", values.ctypes.data)
        status = cancellable(mesh, lambda: lib.beltrami_measure_faces(mesh, uvs, pointer, 0))
    if status < 0:
        check("triangles", uv, faces)  # the measures name no element, this does
        fail(status, "", _first_odd_vertex(vertices, faces), lib.BELTRAMI_ELEMENT_VERTEX)
    return record(out, Energy), values


def _first_odd_vertex(vertices: Array, faces: Array) -> int:
    """Return the first vertex of a face that is not finite, or BELTRAMI_NO_ELEMENT."""
    used = np.unique(faces)
    odd = used[~np.isfinite(vertices[used]).all(axis=1)]
    return int(odd[0]) if len(odd) else int(lib.BELTRAMI_NO_ELEMENT)
