# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Animation of an FBX file: values of its curves at a time, blended over layers.

Blender's importer makes all curves linear between keys, and shows one layer of an object.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from ...core.files import FbxNode
from ...core.numerics import Array, Index, quaternion, rotation_about
from ...core.rig import rotation_values, rotations

ORDERS = ("XYZ", "XZY", "YZX", "YXZ", "ZXY", "ZYX")  # the first letter's rotation acts first
RARE = "it has curves or layers of a rare kind: bake the animation"
_SAME_TIME = 1e-6  # Chosen, in seconds: far below a frame, far above the rounding of times.
# Flags of keys.
_CONSTANT, _CUBIC = 0x2, 0x8  # the section after the key; else it is linear
_OF_NEXT = 0x100  # A constant section has the value of its end.
_TCB, _USER = 0x200, 0x400  # tangents by tension, continuity and bias, or as stored; else automatic
_CLAMPED, _TIMELESS, _PROGRESSIVE = 0x1000, 0x2000, 0x4000  # kinds of automatic tangents
_WEIGHTED, _LEFT_WEIGHTED = 0x1000000, 0x2000000  # of the section after the key: its start, its end
_VELOCITIES = 0x30000000
_LEVEL = 1e-3  # a difference of values, up to which some programs level clamped tangents
_NO_BIAS = 1e-4  # Chosen: an automatic tangent with a larger stored slope may be read differently.


class RareError(Exception):
    """A part of an animation that programs may read differently."""


class FbxAnimation:
    """The animation, at a time, that a file names as the active one.

    If it names none, each node has the first animation that moves it, as in Blender, whose exporter
    makes one for each object.
    """

    def __init__(
        self, root: FbxNode, nodes: dict[int, FbxNode], links: Iterable[list[Any]], seconds: float
    ) -> None:
        self._nodes = nodes
        self._seconds = seconds
        header = root.child("FBXHeaderExtension")
        self._ticks = _ticks_per_second(header)
        self._has_bits = header.child("FBXVersion").first(0) >= 7200
        document = root.child("Documents").child("Document").properties()
        active = document.get("ActiveAnimStackName", ("",))[0]
        kinds = {number: node.name for number, node in nodes.items()}
        stacks = [number for number, kind in kinds.items() if kind == "AnimationStack"]
        stacks = [number for number in stacks if nodes[number].values[1] == active] or stacks
        layers: dict[int, list[int]] = {stack: [] for stack in stacks}
        self._curves: dict[int, dict[str, FbxNode]] = {}
        layer_of: dict[int, int] = {}
        self._parts: dict[int, dict[str, list[int]]] = {}
        for child, parent, *names in links:
            kind = kinds.get(child)
            if kind == "AnimationLayer" and parent in layers:
                layers[parent].append(child)
            elif kind == "AnimationCurve" and names:
                self._curves.setdefault(parent, {})[names[0]] = nodes[child]
            elif kind == "AnimationCurveNode" and names:
                self._parts.setdefault(parent, {}).setdefault(names[0], []).append(child)
            elif kind == "AnimationCurveNode":
                layer_of[child] = parent
        # By layer: the number of its animation, its place among the layers of this, and itself.
        ranks = {
            layer: (number, rank, layer)
            for number, line in enumerate(layers.values())
            for rank, layer in enumerate(line)
        }
        # Programs leave out all other layers, also those of other properties.
        self._has_solo = any(nodes[layer].properties().get("Solo", (0,))[0] for layer in ranks)
        self._ranks = {part: ranks[layer] for part, layer in layer_of.items() if layer in ranks}

    def animate(self, number: int, properties: dict[str, Any]) -> bool:
        """Change the properties of a node to their values at the time, as far as the first
        animation that moves the node animates them. Return False if a value is not certain.
        """
        parts = {
            name: [(*self._ranks[part], part) for part in several if part in self._ranks]
            for name, several in self._parts.get(number, {}).items()
        }
        first = min((animation for line in parts.values() for animation, *_ in line), default=0)
        try:
            for name, line in parts.items():
                layered_parts = [
                    (rank, layer, part)
                    for animation, rank, layer, part in sorted(line)
                    if animation == first
                ]
                if layered_parts:
                    properties[name] = self._blended(layered_parts, name, properties)
        except RareError:
            return False
        return True

    def _blended(
        self, parts: list[tuple[int, int, int]], name: str, properties: dict[str, Any]
    ) -> Array:
        """Return the (k,) values of a property. Raises RareError.

        parts: for each layer, lowest first, its place, its number and that of the values in it.
        properties: of the node, not animated where layers state nothing.
        """
        rest = properties.get(name, (float(name == "Lcl Scaling"),) * 3)
        total = np.array(rest, np.float64)
        is_composed = False
        mode = ORDERS[int(properties.get("RotationOrder", (0,))[0]) % 6]
        for rank, number, part in parts:
            values = self._values(part)
            layer = self._nodes[number].properties()
            if self._has_solo or layer.get("Mute", (0,))[0]:
                raise RareError
            if rank == 0:
                total = values
                continue
            for curves in self._parts.get(number, {}).get("Weight", ()):
                layer["Weight"] = self._values(curves)
            weight = min(max(layer.get("Weight", (100.0,))[0] / 100.0, 0.0), 1.0)
            blending = layer.get("BlendMode", (0,))[0]
            if blending not in (0, 1, 2) or blending == 1 and weight < 1.0:
                raise RareError
            # Modes 0 to 2 add to the layers below, replace them, or do so by the weight.
            kept_share = 1.0 if blending == 0 else 1.0 - weight
            is_turn = name == "Lcl Rotation"
            if is_turn and not layer.get("RotationAccumulationMode", (0,))[0]:
                below, above = rotations(np.radians([total, values]), mode)
                start = np.eye(3) if blending == 0 else below
                turn = quaternion(start.T @ above)
                angle = 2.0 * np.arctan2(np.linalg.norm(turn[1:]), turn[0])
                if angle:
                    below = below @ rotation_about(turn[1:], weight * angle)
                total = np.degrees(rotation_values(below[None], mode, np.radians(total))[0])
                is_composed = True
            elif is_turn and is_composed and kept_share:
                raise RareError  # Several triples of angles are equal to the composed rotation.
            elif name == "Lcl Scaling" and not layer.get("ScaleAccumulationMode", (0,))[0]:
                total = _power(total, kept_share) * _power(values, weight)
            else:
                total = kept_share * total + weight * values
        return total

    def _values(self, part: int) -> Array:
        """Return the one or three numbers of a property in one layer. Raises RareError."""
        rests = {
            name: rest[0]
            for name, rest in self._nodes[part].properties().items()
            if name.startswith("d|")
        }
        curves = self._curves.get(part, {})
        if len(rests) not in (1, 3) or not curves.keys() <= rests.keys():
            raise RareError
        for name, curve in curves.items():
            keys = _Curve(curve, self._ticks, self._has_bits)
            rests[name] = keys.value(self._seconds, rests[name])
        return np.array([*rests.values()])


def _ticks_per_second(header: FbxNode) -> float:
    """Return the ticks of a file's times in a second: the newer count, if its header says so."""
    is_stated = header.child("FBXHeaderVersion").first(0) >= 1004
    definition = header.child("OtherFlags").child("TCDefinition").first(127)
    return 141120000.0 if is_stated and definition != 127 else 46186158000.0


def _power(values: Array, exponent: float) -> Array:
    if 0.0 < exponent < 1.0 and (values < 0.0).any():
        raise RareError
    return values**exponent


class _Curve:
    """The (n,) keys of a curve: times in seconds, values, flags, and (n, 4) float32 data: the slope
    after the key, the slope before the next key, and the weights of both in the bits of the third.

    has_bits: a text states the data by their bits as whole numbers.
    """

    def __init__(self, node: FbxNode, ticks: float, has_bits: bool) -> None:
        self._node = node
        arrays = {child.name: child for child in node.children}
        times, self._values, flags, data, counts = (
            arrays[name].numbers()
            for name in (
                "KeyTime",
                "KeyValueFloat",
                "KeyAttrFlags",
                "KeyAttrDataFloat",
                "KeyAttrRefCount",
            )
        )
        self._times = times / ticks
        repeats = counts.astype(int)
        self._flags: Index = np.repeat(flags.astype(int), repeats)
        if has_bits and arrays["KeyTime"].children:
            data = data.astype(np.int64).astype(np.uint32).view(np.float32)
        self._data = np.repeat(data.astype(np.float32).reshape(-1, 4), repeats, axis=0)

    def value(self, seconds: float, rest: float) -> float:
        """Return its value at a time; `rest` without keys."""
        times, values = self._times, self._values
        if not len(times):
            return rest
        if not times[0] <= seconds <= times[-1]:
            name = "Pre-Extrapolation" if seconds < times[0] else "Post-Extrapolation"
            if self._node.child(name).child("Type").first("C") not in ("C", ord("C")):
                raise RareError
        seconds = min(max(seconds, times[0]), times[-1])
        near = np.abs(times - seconds) <= _SAME_TIME
        if near.any():
            return float(values[near.argmax()])
        index = int(np.searchsorted(times, seconds)) - 1
        flags = int(self._flags[index])
        if flags & _CONSTANT:
            return float(values[index + bool(flags & _OF_NEXT)])
        length = times[index + 1] - times[index]
        share = (seconds - times[index]) / length
        if not flags & _CUBIC:
            return float((1.0 - share) * values[index] + share * values[index + 1])
        if flags & _VELOCITIES:
            raise RareError
        # A Bézier curve whose inner points are at these shares of the section. Its parameter is the
        # root, of the cubic polynomial of the time, that lies between 0 and 1.
        leaving, arriving = self._weights(index)
        start, end = leaving, 1.0 - arriving
        roots = np.roots(
            [1.0 + 3.0 * (start - end), 3.0 * (end - 2.0 * start), 3.0 * start, -share]
        )
        place = roots[np.argmin(np.abs(roots - np.clip(roots.real, 0.0, 1.0)))].real
        left = 1.0 - place
        low = values[index] + leaving * length * self._slope(index, True)
        high = values[index + 1] - arriving * length * self._slope(index + 1, False)
        return float(
            left**3 * values[index]
            + 3.0 * left * place * (left * low + place * high)
            + place**3 * values[index + 1]
        )

    def _weights(self, index: int) -> tuple[float, float]:
        """Return the lengths, as shares of a section, of the tangents at its start and its end: a
        third, or as stored in units of 1e-4.
        """
        flags = int(self._flags[index])
        bits = int(self._data[index, 2:3].view(np.uint32)[0])
        return (
            (bits & 0xFFFF) * 1e-4 if flags & _WEIGHTED else 1.0 / 3.0,
            (bits >> 16) * 1e-4 if flags & _LEFT_WEIGHTED else 1.0 / 3.0,
        )

    def _slope(self, index: int, is_after: bool) -> float:
        """Return the slope, per second, after or before a key; there the curve is cubic.

        Raises RareError.
        """
        flags = int(self._flags[index])
        previous = int(self._flags[index - 1])
        stored_slope = float(self._data[index, 0] if is_after else self._data[index - 1, 1])
        is_inner = 0 < index < len(self._times) - 1
        near_keys = slice(max(index - 1, 0), index + 2)
        # Of the sections before and after the key, of one at the ends of the curve.
        times, changes = np.diff(self._times[near_keys]), np.diff(self._values[near_keys])
        slopes = changes / times
        if flags & _CUBIC and flags & _TCB:  # a Kochanek-Bartels spline
            before = slopes[0] if index else 0.0
            after = slopes[-1] if index < len(self._times) - 1 else 0.0
            tension, continuity, bias = map(float, self._data[index, :3])
            continuity = continuity if is_after else -continuity
            return (
                (0.5 if is_inner else 1.0)
                * (1.0 - tension)
                * (
                    (1.0 + bias) * (1.0 + continuity) * before
                    + (1.0 - bias) * (1.0 - continuity) * after
                )
            )
        if not flags & _CUBIC or flags & _USER:
            if not is_after and previous & _TCB:
                raise RareError
            return stored_slope
        least = np.abs(changes).min() if flags & _CLAMPED else np.inf
        if abs(stored_slope) > _NO_BIAS or 0.0 < least <= _LEVEL:
            raise RareError
        if least == 0.0:
            return 0.0
        if not is_inner:
            return 0.0 if flags & _PROGRESSIVE else float(slopes[0])
        slope = changes.sum() / times.sum()
        if not flags & _TIMELESS:  # half of the mean slope, weighted by the other section's time
            slope = 0.5 * slope + 0.5 * (slopes @ times[::-1]) / times.sum()
        if flags & _PROGRESSIVE:  # The tangents do not pass the values of the next keys.
            weights = self._weights(index - 1)[1], self._weights(index)[0]
            limits = np.sign(slope) * slopes / weights
            slope = np.sign(slope) * min(abs(slope), max(limits.min(), 0.0))
        return float(slope)
