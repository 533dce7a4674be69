// The module houghstream._native: what houghstream.finder and houghstream.listener, which check arguments and name
// results, are made of.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <variant>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "tools/finder/object_finder.hpp"
#include "tools/python/native_values.hpp"
#include "tools/python/result_listener.hpp"

namespace py = pybind11;

namespace houghstream {
namespace {

using Bytes = py::array_t<std::uint8_t, py::array::c_style>;

/// A finder that any thread may call; calls of several follow one another.
class NativeFinder {
 public:
  NativeFinder(const std::string& store, const FinderOptions& options) : finder_(store, options) {}

  py::dict find(const Bytes& colour, const py::array& depth, const py::tuple& camera, bool is_bgr) {
    const FrameArrays arrays = arrays_of(colour, depth, camera, is_bgr);
    FoundObjects found;
    {
      const py::gil_scoped_release release;
      const RgbdFrame frame = make_frame(arrays);
      const std::lock_guard<std::mutex> lock(mutex_);
      found = finder_.find(frame);
    }
    return to_python(found, finder_);
  }

  py::list names() const {
    py::list names;
    for (const FinderObject& object : finder_.objects()) names.append(object.name);
    return names;
  }

 private:
  static FrameArrays arrays_of(const Bytes& colour, const py::array& depth, const py::tuple& camera, bool is_bgr) {
    const bool is_mm = py::isinstance<py::array_t<std::uint16_t, py::array::c_style>>(depth);
    require(is_mm || py::isinstance<py::array_t<float, py::array::c_style>>(depth),
            "depth: expected uint16 or float32 in rows without gaps");
    require(colour.ndim() == 3 && colour.shape(2) == 3 && depth.ndim() == 2 && depth.shape(0) == colour.shape(0) &&
                depth.shape(1) == colour.shape(1),
            "colour and depth: expected height x width x 3 and height x width");
    FrameArrays arrays;
    arrays.colour = colour.data();
    arrays.is_bgr = is_bgr;
    arrays.depth = depth.data();
    arrays.is_depth_in_mm = is_mm;
    arrays.camera.width = static_cast<int>(colour.shape(1));
    arrays.camera.height = static_cast<int>(colour.shape(0));
    arrays.camera.fx = camera[0].cast<double>();
    arrays.camera.fy = camera[1].cast<double>();
    arrays.camera.cx = camera[2].cast<double>();
    arrays.camera.cy = camera[3].cast<double>();
    return arrays;
  }

  std::mutex mutex_;
  ObjectFinder finder_;
};

std::unique_ptr<NativeFinder> make_finder(const std::string& store, int threads, std::optional<float> threshold,
                                          std::optional<float> min_quality, std::optional<double> precision) {
  const py::gil_scoped_release release;
  FinderOptions options;
  options.threads = threads;
  options.threshold = threshold;
  options.min_quality = min_quality;
  options.precision = precision;
  return std::make_unique<NativeFinder>(store, options);
}

std::unique_ptr<ResultListener> make_listener(const std::string& url, const std::string& cameras, bool poses,
                                              bool objects) {
  const py::gil_scoped_release release;
  ListenOptions options;
  options.url = url;
  options.cameras = cameras;
  options.poses = poses;
  options.objects = objects;
  return std::make_unique<ResultListener>(options);
}

/// Waits for the next result; None at the end of a log. Python's signals are looked after meanwhile, so that Ctrl-C
/// raises KeyboardInterrupt.
py::object next_result(ResultListener& listener) {
  constexpr std::chrono::milliseconds kTimeout(50);
  while (true) {
    std::optional<StreamResult> result;
    bool has_ended = false;
    {
      const py::gil_scoped_release release;
      result = listener.next(kTimeout);
      has_ended = listener.has_ended();
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (result) return std::visit([](const auto& value) { return py::object(to_python(value)); }, *result);
    if (has_ended) return py::none();
  }
}

}  // namespace
}  // namespace houghstream

PYBIND11_MODULE(_native, module) {
  using namespace houghstream;
  start_log("houghstream", LogLevel::kInfo);  // on stderr: what the program prints is its own
  py::register_exception<InputError>(module, "InputError", PyExc_ValueError).attr("__module__") = "houghstream";
  py::class_<NativeFinder>(module, "Finder")
      .def(py::init(&make_finder), py::arg("store"), py::arg("threads"), py::arg("threshold"), py::arg("min_quality"),
           py::arg("precision"))
      .def("find", &NativeFinder::find, py::arg("colour"), py::arg("depth"), py::arg("camera"), py::arg("is_bgr"))
      .def("names", &NativeFinder::names);
  py::class_<ResultListener>(module, "Listener")
      .def(py::init(&make_listener), py::arg("url"), py::arg("cameras"), py::arg("poses"), py::arg("objects"))
      .def("next", &next_result);
}
