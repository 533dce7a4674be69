"""Results of a frame and of the world: poses and objects with their evidence.

Lengths are metres and angles radians; pixels count from the centre of the first one; a camera looks along z, with x to the
right and y down.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, overload

import numpy
import numpy.typing

Array = numpy.typing.NDArray[numpy.float64]


class Box(NamedTuple):
    """The visible part of an object, pixels of the colour image."""

    x: float  # left edge
    y: float  # upper edge
    width: float
    height: float


class Bounds(NamedTuple):
    """The box about an object's mesh along the axes of the object's own frame, metres."""

    lower: Array  # (3,)
    upper: Array  # (3,)

    @property
    def extents(self) -> Array:
        """(3,) sizes along x, y and z of the object's frame, metres."""
        return self.upper - self.lower

    def corners(self, matrix: Array) -> Array:
        """(8, 3) corners of the box in the frame that `matrix` (4, 4) leads to, metres."""
        choices = numpy.array([[index >> axis & 1 for axis in range(3)] for index in range(8)], bool)
        points = numpy.where(choices, self.upper, self.lower)
        corners: Array = points @ matrix[:3, :3].T + matrix[:3, 3]
        return corners


@dataclass(frozen=True, eq=False)
class Pose:
    """An object found in a frame: where it is, with the evidence for it."""

    name: str
    """Name of the object in its store."""
    matrix: Array
    """(4, 4), takes points of the object's frame to the camera's, metres."""
    score: float
    """Probability that such an object is there, 0 to 1, as the detector sees it."""
    quality: float
    """Probability that the pose is right, 0 to 1."""
    shape_quality: float
    """Probability that it is right up to the symmetries of the object's shape, 0 to 1; never below `quality`."""
    up_to_symmetry: bool
    """True where only the latter is sure: it may be turned to another side that looks alike by its shape."""
    status: str
    """"valid", or "valid up to its shape's symmetry"."""
    inliers: int
    """Points of the model that have a partner in the measured depth."""
    inlier_fraction: float
    """Inliers as a fraction of the points that were used, 0 to 1."""
    residual: float
    """Root mean square distance of the inliers to the model, metres; nan where there are none."""
    visible_fraction: float
    """Fraction of the model's rendered pixels that agree with the measured depth, 0 to 1."""
    free_space_violation: float
    """Fraction of the model's rendered pixels in front of what was measured, 0 to 1."""
    box: Box | None
    """The object in the image, pixels; None from a bus where its detection was not received."""
    covariance: Array | None
    """(6, 6) of the pose: translation, metres^2, then rotation, radians^2, along and about the camera's axes; None from a bus."""
    bounds: Bounds | None
    """The box about the object in its own frame, metres; None from a bus."""

    @property
    def position(self) -> Array:
        """(3,) origin of the object's frame in the camera's, metres."""
        return self.matrix[:3, 3]

    @property
    def rotation(self) -> Array:
        """(3, 3) rotation from the object's frame to the camera's."""
        return self.matrix[:3, :3]

    @property
    def extents(self) -> Array | None:
        """(3,) sizes of the object along the axes of its own frame, metres; None from a bus."""
        return None if self.bounds is None else self.bounds.extents

    @property
    def corners(self) -> Array | None:
        """(8, 3) corners of the oriented box about the object in the camera's frame, metres; None from a bus."""
        return None if self.bounds is None else self.bounds.corners(self.matrix)

    def __repr__(self) -> str:
        return f"Pose({self.name} at {_place(self.matrix)} m, quality {self.quality:.2f})"


@dataclass(frozen=True, eq=False)
class NoPose:
    """A detection that has no pose, with the reason."""

    name: str
    """Name of the object in its store."""
    score: float
    """Probability that such an object is there, 0 to 1, as the detector sees it."""
    status: str
    """Why it has no pose: "too few points", "rejected by depth", "low score", "refuted" (it is none), ..."""
    box: Box | None
    """The detection in the image, pixels; None from a bus where it was not received."""


class FoundPoses(Sequence[Pose]):
    """The objects found in one frame: a sequence of their poses, in the order of their detections, strongest first."""

    def __init__(self, utime: int, camera: str, poses: list[Pose], without_pose: list[NoPose]) -> None:
        self.utime = utime
        """Time of the frame, microseconds since the epoch; 0 where it did not come over a bus."""
        self.camera = camera
        """Channel of the frame; "" where it did not come over a bus."""
        self.without_pose = without_pose
        """Detections of which no pose was found, with the reason."""
        self._poses = poses

    @overload
    def __getitem__(self, index: int) -> Pose: ...
    @overload
    def __getitem__(self, index: slice) -> list[Pose]: ...
    def __getitem__(self, index: int | slice) -> Pose | list[Pose]:
        return self._poses[index]

    def __len__(self) -> int:
        return len(self._poses)

    def __repr__(self) -> str:
        return f"FoundPoses({self._poses}, without_pose={self.without_pose})"


@dataclass(frozen=True, eq=False)
class WorldObject:
    """One object of the world, as hs-track knows it over frames and cameras."""

    number: int
    """Its number, which stays, from 1."""
    name: str
    """Name of the object in its store."""
    state: str
    """"visible", "unrecognised" (the depth is as it should be), "hidden", "out of view" or "gone"."""
    probability: float
    """Probability that it is where it is said to be, 0 to 1."""
    moving: bool
    """True while it moves; else its pose is an average."""
    matrix: Array
    """(4, 4), takes points of the object's frame to the world's, metres."""
    covariance: Array
    """(6, 6) of the pose: translation, metres^2, then rotation, radians^2, along and about the world's axes."""
    velocity: Array
    """(6,) metres a second, then radians a second, along and about the world's axes; 0 while it stands."""
    times_seen: int
    """Frames with a pose of it."""
    first_utime: int
    """When it was seen first, microseconds since the epoch."""
    seen_utime: int
    """Time of the frame with its last pose, microseconds since the epoch."""
    seen_by: str
    """Channel of that frame."""
    reason: str
    """Why it is in its state, one line."""
    box_matrix: Array | None
    """(4, 4), takes points of the box about the object to the world's frame, metres, its middle being the origin; None where
    hs-track knows no model of it."""
    extents: Array | None
    """(3,) sizes of that box along its own axes, metres."""
    frames: dict[str, Array]
    """Frames that are named on the object (hs-teach frame), by name: (4, 4), to the world's frame, metres."""

    @property
    def position(self) -> Array:
        """(3,) origin of the object's frame in the world's, metres."""
        return self.matrix[:3, 3]

    @property
    def corners(self) -> Array | None:
        """(8, 3) corners of the oriented box about the object in the world's frame, metres; None where it is not known."""
        if self.box_matrix is None or self.extents is None:
            return None
        return Bounds(-0.5 * self.extents, 0.5 * self.extents).corners(self.box_matrix)

    def __repr__(self) -> str:
        return f"WorldObject({self.name} {self.number} at {_place(self.matrix)} m, {self.state})"


class WorldObjects(Sequence[WorldObject]):
    """All objects of the world after one frame: a sequence in the order of their numbers."""

    def __init__(self, values: dict[str, Any], objects: list[WorldObject]) -> None:
        self.utime: int = values["utime"]
        """Time of the frame after which the world is so, microseconds since the epoch."""
        self.camera: str = values["camera"]
        """Channel of that frame."""
        self.world: str = values["world"]
        """Frame that the objects are in: "WORLD", or, without any camera's place, the camera's channel."""
        self.world_number: int = values["world_number"]
        """Counts worlds from 1: a log that starts again begins a new one."""
        self.camera_matrix: Array = values["camera_matrix"]
        """(4, 4), takes points of the camera's frame to the world's, metres, at the time of the frame."""
        self._objects = objects

    @overload
    def __getitem__(self, index: int) -> WorldObject: ...
    @overload
    def __getitem__(self, index: slice) -> list[WorldObject]: ...
    def __getitem__(self, index: int | slice) -> WorldObject | list[WorldObject]:
        return self._objects[index]

    def __len__(self) -> int:
        return len(self._objects)

    def __repr__(self) -> str:
        return f"WorldObjects({self._objects})"


def make_poses(values: dict[str, Any]) -> FoundPoses:
    """The poses of what the native module returns."""
    for entry in (*values["poses"], *values["without_pose"]):
        entry["box"] = Box(*entry["box"]) if entry["box"] else None
    for entry in values["poses"]:
        entry["bounds"] = Bounds(*entry["bounds"]) if entry["bounds"] else None
    poses = [Pose(**entry) for entry in values["poses"]]
    without_pose = [NoPose(**entry) for entry in values["without_pose"]]
    return FoundPoses(values["utime"], values["camera"], poses, without_pose)


def make_world(values: dict[str, Any]) -> WorldObjects:
    """The world of what the native module returns."""
    return WorldObjects(values, [WorldObject(**entry) for entry in values["objects"]])


def _place(matrix: Array) -> str:
    return " ".join(f"{value:.3f}" for value in matrix[:3, 3])
