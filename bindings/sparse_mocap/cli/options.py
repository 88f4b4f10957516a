# SPDX-License-Identifier: GPL-3.0-or-later
"""Options shared by several commands."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any

import click

from .. import noise_presets, site_names
from ..methods import DEFAULT_METHOD, MethodInfo, method_info, methods, renamed_preset
from .console import warn

__all__ = [
    "MethodChoice",
    "OutputPath",
    "PositionAlongBone",
    "SensorSite",
    "Setting",
    "Sites",
    "Span",
    "Unit",
    "check_ending",
    "method_choice",
    "positions_along_bone_of",
    "reading_options",
]

PAPER_SITES = "left_wrist,right_wrist,left_ankle,right_ankle"

FilePath = click.Path(path_type=Path)

_MOTION_ENDINGS = (".bvh", ".amc", ".asf", ".npz", ".mvnx")
_UNITS_M = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "foot": 0.3048,
            "cmu": 0.0254 / 0.45}  # fmt: skip

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]


class Unit(click.ParamType):  # type: ignore[type-arg]
    """A unit of length."""

    name = "UNIT"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Returns the metres of one unit."""
        text = str(value).lower()
        try:
            return _UNITS_M[text] if text in _UNITS_M else float(text)
        except ValueError:
            self.fail(
                f"{value!r} is no unit; choose from {', '.join(_UNITS_M)}, or write its metres",
                param, ctx,
            )  # fmt: skip


class OutputPath(click.Path):
    """A file to write that is no motion file, which a slip would cost its recording."""

    def __init__(self) -> None:
        super().__init__(path_type=Path)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        """Returns the path."""
        path = Path(value)
        if path.suffix.lower() in _MOTION_ENDINGS:
            self.fail(f"'{path}' is the name of a motion file; choose another name", param, ctx)
        return path


class Sites(click.ParamType):  # type: ignore[type-arg]
    """A list of sensor locations, separated by commas."""

    name = "SITE,..."

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, ...]:
        """Returns the locations, all known and different."""
        if isinstance(value, tuple):
            return value
        sites = tuple(site.strip() for site in str(value).split(","))
        known = site_names()
        for site in sites:
            if site not in known:
                self.fail(
                    f"unknown sensor location {site!r}; choose from {', '.join(known)}", param, ctx
                )
        if len(set(sites)) < len(sites):
            self.fail("a sensor location is given twice", param, ctx)
        return sites


class SensorSite(click.ParamType):  # type: ignore[type-arg]
    """A sensor, by its name or identity, and its location."""

    name = "NAME=SITE"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, str]:
        """Returns the sensor's name and its site."""
        if isinstance(value, tuple):
            return value
        name, is_given, site = str(value).rpartition("=")
        if not is_given:
            self.fail(f"{value!r} is not NAME=SITE", param, ctx)
        (site,) = Sites().convert(site, param, ctx)
        return name.strip(), site


class PositionAlongBone(click.ParamType):  # type: ignore[type-arg]
    """A sensor location and the sensor's position along the bone."""

    name = "SITE=X"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, float]:
        """Returns the location and the position along the bone."""
        if isinstance(value, tuple):
            return value
        site, _, text = str(value).partition("=")
        (site,) = Sites().convert(site, param, ctx)
        try:
            position = float(text)
        except ValueError:
            position = -1.0
        if not 0.0 <= position <= 1.0:
            self.fail(f"{text!r} is not a position from 0 (near the body) to 1", param, ctx)
        return site, position


class Setting(click.ParamType):  # type: ignore[type-arg]
    """An option of a method and its value."""

    name = "KEY=VALUE"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, str]:
        """Returns the option's name and its value."""
        if isinstance(value, tuple):
            return value
        name, equals, text = str(value).partition("=")
        if not (name and equals and text):
            self.fail(f"{value!r} is not KEY=VALUE, as in num_paths=128", param, ctx)
        return name.strip(), text.strip()


class Span(click.ParamType):  # type: ignore[type-arg]
    """A time span of a take."""

    name = "FROM:TO"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, float]:
        """Returns from and to in seconds."""
        if isinstance(value, tuple):
            return value
        begin_text, _, end_text = str(value).partition(":")
        try:
            begin_s, end_s = float(begin_text), float(end_text)
        except ValueError:
            begin_s, end_s = 0.0, 0.0
        if not (begin_s < end_s and isfinite(begin_s) and isfinite(end_s)):
            self.fail(f"{value!r} is not FROM:TO in seconds, such as 2.5:10", param, ctx)
        return begin_s, end_s


def _position_option(name: str) -> Decorator:
    """Adds the parameter ``name``: locations and positions along the bones.

    The old name --place still works.
    """

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(command)
        def with_old_name(*args: Any, place: tuple[tuple[str, float], ...], **more: Any) -> Any:
            if place:
                current = " ".join(f"--position-along-bone {site}={x:g}" for site, x in place)
                warn([f"--place is now called --position-along-bone: write {current}"])
                more[name] = (*more[name], *place)
            return command(*args, **more)

        option = click.option(
            "--position-along-bone", name, type=PositionAlongBone(), multiple=True,
            help="Position of a sensor along its bone, from 0 (elbow, knee) to 1 (wrist, ankle; the"
            " default), as in left_ankle=0.4. Can be repeated.",
        )  # fmt: skip
        old = click.option("--place", type=PositionAlongBone(), multiple=True, hidden=True)
        return option(old(with_old_name))

    return decorate


position_along_bone_option: Decorator = _position_option("positions_along_bone")

frame_option: Decorator = click.option(
    "--frame", type=click.Choice(["heading", "root", "world"]), default="heading",
    show_default=True,
    help="Frame of the positions: root position and heading removed, root position and full"
    " orientation removed, or world.",
)  # fmt: skip

offline_option: Decorator = click.option(
    "--offline", is_flag=True,
    help="Best quality: use the whole take for every frame. Without it, live quality.",
)  # fmt: skip

gyroscopes_option: Decorator = click.option(
    "--gyroscopes/--no-gyroscopes", default=True, show_default=True,
    help="Also use gyroscopes (gx,gy,gz) and orientations (qw,qx,qy,qz) where sensors have them.",
)  # fmt: skip

calibration_option: Decorator = click.option(
    "--calibration", "calibration_path", type=FilePath, help="The sensors' calibration (.json)."
)

extremities_option: Decorator = click.option(
    "--extremities", is_flag=True, help="Write the positions of feet, toes and hands as well."
)

noise_option: Decorator = click.option(
    "--noise", type=click.Choice(list(noise_presets())), default="none", show_default=True,
    help="Quality of the simulated sensors: ideal, accelerometers of research or consumer grade, or"
    " trackers: optical, ultrasonic or inertial.",
)  # fmt: skip


class _Channels(click.ParamType):  # type: ignore[type-arg]
    """What simulated sensors give, separated by commas."""

    name = "channels"
    possible = ("specific_force", "angular_velocity", "orientation", "position")

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, ...]:
        names = tuple(value.split(",")) if isinstance(value, str) else tuple(value)
        for name in names:
            if name not in self.possible:
                self.fail(f"{name!r} is none of {', '.join(self.possible)}", param, ctx)
        return names


channels_option: Decorator = click.option(
    "--channels", type=_Channels(), default="specific_force", show_default=True,
    help="What the simulated sensors give, separated by commas: "
    + ", ".join(_Channels.possible) + ".",
)  # fmt: skip

seed_option: Decorator = click.option(
    "--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Seed of the noise."
)

method_option: Decorator = click.option(
    "--method", type=click.Choice([method.name for method in methods()]),
    help=f"The reconstruction method; `methods` describes them.  [default: {DEFAULT_METHOD}]",
)  # fmt: skip

set_option: Decorator = click.option(
    "--set", "settings", type=Setting(), multiple=True, metavar="KEY=VALUE",
    help="Set an option of the method; `methods NAME` lists them. Can be repeated.",
)  # fmt: skip

preset_option: Decorator = click.option(
    "--preset", help="A preset of the method; `methods NAME` lists them."
)

model_option: Decorator = click.option(
    "--model", "model_path", metavar="M.smmodel", type=FilePath,
    help="The trained model, for methods that need one; see `train`.",
)  # fmt: skip

body_option: Decorator = click.option(
    "--body", "body_path", metavar="BODY.json", type=FilePath,
    help="The performer's body, for methods that need one; see `body`.",
)  # fmt: skip

scheduler_option: Decorator = click.option(
    "--scheduler", metavar="ADDRESS",
    help="A Dask scheduler whose workers do the work, as in tcp://10.0.0.1:8786. Files must be on a"
    " disk that all of them share.",
)  # fmt: skip


@dataclass(frozen=True)
class MethodChoice:
    """The method that the command line chooses, with its settings."""

    method: str
    preset: str | None
    options: dict[str, str]

    @property
    def info(self) -> MethodInfo:
        """The method."""
        return method_info(self.method)


def method_choice(
    method: str | None, preset: str | None, options: Sequence[tuple[str, str]] = ()
) -> MethodChoice:
    """Returns the chosen method, with a warning if the name is an old one.

    Raises BadParameter for a preset that the method does not have.
    """
    method, preset, renamed = renamed_preset(method, preset)
    if renamed:
        warn([renamed])
    info = method_info(method or DEFAULT_METHOD)
    known = [known.name for known in info.presets]
    if preset is not None and preset not in known:
        raise click.BadParameter(
            f"{info.name} has no preset {preset!r}; choose from {', '.join(known)}",
            param_hint="'--preset'",
        )
    return MethodChoice(info.name, preset, dict(options))


def positions_along_bone_of(
    sites: Sequence[str], positions: Sequence[tuple[str, float]]
) -> list[float] | None:
    """Returns a position for each site, or None if none are given. Raises BadParameter."""
    given = dict(positions)
    for site in given:
        if site not in sites:
            raise click.BadParameter(
                f"there is no sensor at {site}", param_hint="'--position-along-bone'"
            )
    return [given.get(site, 1.0) for site in sites] if given else None


def check_ending(path: Path, *endings: str) -> str:
    """Returns the path's extension in lower case. Raises BadParameter for another one."""
    ending = path.suffix.lower()
    if ending not in endings:
        raise click.BadParameter(
            f"'{path}' must end in {' or '.join(endings)}", param_hint="'--output'"
        )
    return ending


def reading_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """What motion files do not say: --rate, --unit, --up, --asf.

    The command gets them as ``reading``, keyword arguments of read_motion and read_options.
    """

    @functools.wraps(command)
    def with_reading(
        *args: Any, rate: float, unit: float | None, up: str, asf: Path | None, **options: Any
    ) -> Any:
        reading = {"amc_rate_hz": rate, "unit_m": unit, "up": up, "asf": asf}
        return command(*args, reading=reading, **options)

    for option in (
        click.option(
            "--asf", type=FilePath,
            help="The skeleton of .amc files, instead of the one beside each.",
        ),
        click.option(
            "--up", type=click.Choice(("x", "y", "z")), default="y", show_default=True,
            help="The axis that is up in the files.",
        ),
        click.option(
            "--unit", type=Unit(),
            help="The files' unit of length: " + ", ".join(_UNITS_M) + " (of CMU's files), or in"
            " metres; by default what an .asf says, and cm for .bvh.",
        ),
        click.option(
            "--rate", metavar="HZ", type=click.FloatRange(1.0, 10_000.0), default=120.0,
            show_default=True, help="Frames per second of .amc files, which do not say it.",
        ),
    ):  # fmt: skip
        with_reading = option(with_reading)
    return with_reading
