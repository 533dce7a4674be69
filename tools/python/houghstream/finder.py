"""Finds the objects of an object store (hs-teach) in single images, without LCM."""

from __future__ import annotations

import numbers
import os
from typing import Any, Literal, NamedTuple, Protocol

import numpy
import numpy.typing

from houghstream._native import Finder
from houghstream._native import InputError as InputError
from houghstream.results import FoundPoses, make_poses

MOST_THREADS = 64


class Camera(NamedTuple):
    """A pinhole camera without distortion, pixels; the centre of the first pixel is (0, 0)."""

    fx: float
    fy: float
    cx: float
    cy: float

    @classmethod
    def from_matrix(cls, matrix: numpy.typing.ArrayLike) -> Camera:
        """The camera of a 3 x 3 matrix K, as OpenCV and ROS have it."""
        values = numpy.asarray(matrix, float)
        if values.shape != (3, 3):
            raise InputError(f"camera: found a matrix of shape {values.shape}, expected (3, 3)")
        return cls(float(values[0, 0]), float(values[1, 1]), float(values[0, 2]), float(values[1, 2]))


class AnyCamera(Protocol):
    """Anything that has a camera's numbers: Camera, camera_t, ..."""

    @property
    def fx(self) -> float: ...
    @property
    def fy(self) -> float: ...
    @property
    def cx(self) -> float: ...
    @property
    def cy(self) -> float: ...


class ObjectFinder:
    """Finds the objects of a store in images: what hs-detect and hs-pose do in a stream.

    Other Python threads go on while it works. Calls of several threads follow one another: for more at once, each thread
    makes a finder of its own.
    """

    def __init__(
        self,
        store: str | os.PathLike[str],
        *,
        threads: int = 2,
        threshold: float | None = None,
        min_quality: float | None = None,
        precision: float | None = None,
    ) -> None:
        """Reads the store, which takes seconds.

        threads: 1 to 64; any number gives the same result.
        threshold: least score of what is reported, 0 to 1; None: that of hs-detect.
        min_quality: least quality of a pose that is valid, 0 to 1; None: that of hs-pose.
        precision: instead of both, fraction of what is reported that is to be right, 0 to below 1: each object has the
            least score and quality that its practice (hs-teach) needed for it; a warning names those that do not reach it.
        Raises InputError, a ValueError, where the folder is no store, is half written or of another version, and for a
        number out of its range, TypeError for what is no number.
        """
        for name, value in (("threads", threads), ("threshold", threshold), ("min_quality", min_quality), ("precision", precision)):
            if value is not None and not isinstance(value, numbers.Real):
                raise TypeError(f"{name}: found {value!r}, expected a number")
        if not 1 <= threads <= MOST_THREADS:
            raise InputError(f"threads: found {threads}, expected 1 to {MOST_THREADS}")
        for name, value in (("threshold", threshold), ("min_quality", min_quality)):
            if value is not None and not 0 <= value <= 1:
                raise InputError(f"{name}: found {value}, expected 0 to 1")
        if precision is not None and not 0 <= precision < 1:
            raise InputError(f"precision: found {precision}, expected 0 to below 1")
        if precision is not None and (threshold, min_quality) != (None, None):
            raise InputError("precision: found a threshold or min_quality beside it, expected one or the other")
        self._store = os.fspath(store)
        self._finder = Finder(self._store, threads, threshold, min_quality, precision)

    def __repr__(self) -> str:
        return f"ObjectFinder({self._store!r}): {', '.join(self.names)}"

    @property
    def names(self) -> list[str]:
        """Names of the store's objects, sorted."""
        return self._finder.names()

    def find(
        self,
        colour: numpy.typing.NDArray[Any],
        depth: numpy.typing.NDArray[Any],
        camera: AnyCamera | tuple[float, float, float, float],
        *,
        colour_order: Literal["rgb", "bgr"] = "rgb",
    ) -> FoundPoses:
        """Finds the objects in one image. The same image gives the same result, bit for bit.

        colour: (height, width, 3), uint8, red first; blue first, as cv2.imread() has it, with colour_order="bgr".
        depth: (height, width), registered to colour, along the optical axis: uint16 in millimetres, 0 where there is none,
            or float32 or float64 in metres, 0 or nan where there is none.
        camera: Camera, or fx, fy, cx, cy, pixels.
        Arrays may have strides. Returns the poses, strongest detection first; those without a pose are in `without_pose`.
        Raises TypeError for arrays of another type, InputError for shapes and numbers that do not fit.
        """
        _check_images(colour, depth)
        if colour_order not in ("rgb", "bgr"):
            raise InputError(f"colour_order: found {colour_order!r}, expected 'rgb' or 'bgr'")
        metric = depth if depth.dtype == numpy.uint16 else depth.astype(numpy.float32)
        numbers = _camera_numbers(camera, colour.shape[1], colour.shape[0])
        images = (numpy.ascontiguousarray(colour), numpy.ascontiguousarray(metric))
        return make_poses(self._finder.find(*images, numbers, colour_order == "bgr"))


def _check_images(colour: Any, depth: Any) -> None:
    for name, image in (("colour", colour), ("depth", depth)):
        if not isinstance(image, numpy.ndarray):
            raise TypeError(f"{name}: found {type(image).__name__}, expected a numpy array")
    if colour.dtype != numpy.uint8:
        raise TypeError(f"colour: found {colour.dtype}, expected uint8")
    if not any(depth.dtype == known for known in (numpy.uint16, numpy.float32, numpy.float64)):
        raise TypeError(f"depth: found {depth.dtype}, expected uint16 (millimetres) or float32 (metres)")
    if colour.ndim != 3 or colour.shape[2] != 3:
        raise InputError(f"colour: found shape {colour.shape}, expected (height, width, 3)")
    if depth.shape != colour.shape[:2]:
        raise InputError(f"depth: found shape {depth.shape}, expected {colour.shape[:2]}, that of colour")


def _camera_numbers(camera: Any, width: int, height: int) -> tuple[float, float, float, float]:
    """fx, fy, cx, cy; where the camera has a size, it must be that of the images."""
    sizes = [getattr(camera, name, None) for name in ("width", "height")]
    if None not in sizes and sizes != [width, height]:
        raise InputError(f"camera: found {sizes[0]} x {sizes[1]} pixels, expected {width} x {height}, those of colour")
    try:
        if all(hasattr(camera, name) for name in Camera._fields):
            camera = tuple(getattr(camera, name) for name in Camera._fields)
        fx, fy, cx, cy = (float(value) for value in camera)
    except (TypeError, ValueError) as error:
        found = f"an array of shape {camera.shape}" if isinstance(camera, numpy.ndarray) else repr(camera)
        raise TypeError(f"camera: found {found}, expected Camera(fx, fy, cx, cy), these four numbers, or "
                        "Camera.from_matrix(K)") from error  # fmt: skip
    return fx, fy, cx, cy
