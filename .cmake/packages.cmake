# Debian packages, with the target `package`: houghstream, libhoughstream-dev, python3-houghstream, houghstream-java, and
# houghstream-samples where the samples have been made (samples.cmake).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME houghstream)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_VENDOR Houghstream)
set(CPACK_PACKAGE_CONTACT "The Houghstream engineers <houghstream@example.org>")
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL programs development python ${samples_component})
if(TARGET houghstream_types_jar)
  list(APPEND CPACK_COMPONENTS_ALL java)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME houghstream)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
# houghstream-demo reads messages with the Python of the same version, hs-import MATLAB files with scipy.
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS "python3-houghstream (= ${PROJECT_VERSION}), python3, python3-matplotlib, python3-jinja2, python3-pil, python3-scipy, liblcm-bin, iproute2")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "houghstream-java, libopenni2-0, libjs-three")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "houghstream-samples")
set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION "finds taught objects in an RGB-D camera's stream, and their poses
Processes for capture, detection (a depth-normalised Hough forest) and pose
estimation (ICP) that exchange LCM messages, and tools that teach, view, log,
measure and mend.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libhoughstream-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "liblcm-dev, libopencv-dev, libturbojpeg0-dev, libdeflate-dev, libzstd-dev, libbz2-dev, liblz4-dev, libeigen3-dev, libhwy-dev, libassimp-dev, libre2-dev, libyaml-cpp-dev, libspdlog-dev, libfmt-dev, nlohmann-json3-dev, pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "g++, cmake, make")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "finds taught objects in an RGB-D camera's stream: libraries
Static libraries, headers, message definitions, CMake and pkg-config files,
and examples.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-houghstream)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3, python3-numpy, python3-pil")
if(TARGET houghstream_native) # which is of one machine and one Python
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  get_target_property(python_minor houghstream_native PYTHON_MINOR)
  math(EXPR next_python "${python_minor} + 1")
  string(PREPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${python_minor}), python3 (<< 3.${next_python}), ")
else()
  set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
endif()
file(WRITE "${PROJECT_BINARY_DIR}/python_package/prerm"
"#!/bin/sh
set -e
# What Python has compiled while root used it.
rm -rf /usr/lib/python3/dist-packages/houghstream/__pycache__
")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${PROJECT_BINARY_DIR}/python_package/prerm")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "finds taught objects in an RGB-D camera's stream: Python
ObjectFinder, which finds them in numpy arrays; what a stream publishes;
message types, logs, and frames as numpy arrays.")

set(CPACK_DEBIAN_JAVA_PACKAGE_NAME houghstream-java)
set(CPACK_DEBIAN_JAVA_PACKAGE_SECTION java)
set(CPACK_DEBIAN_JAVA_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_JAVA_PACKAGE_DEPENDS "default-jre, liblcm-java, libjchart2d-java")
set(CPACK_DEBIAN_JAVA_PACKAGE_RECOMMENDS "default-jdk-headless") # java FILE.java, as the example is started, compiles it
set(CPACK_COMPONENT_JAVA_DESCRIPTION "finds taught objects in an RGB-D camera's stream: Java
Message types, and viewers for lcm-spy.")

set(CPACK_DEBIAN_SAMPLES_PACKAGE_NAME houghstream-samples)
set(CPACK_DEBIAN_SAMPLES_PACKAGE_SECTION science)
set(CPACK_DEBIAN_SAMPLES_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_SAMPLES_PACKAGE_DEPENDS "houghstream (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_COMPRESSION_TYPE xz) # the forest becomes a third of its size
set(CPACK_COMPONENT_SAMPLES_DESCRIPTION "finds taught objects in an RGB-D camera's stream: samples
Four taught objects and ten seconds of a rendered recording, which
houghstream-demo shows.")

# Each package has its copyright file and a changelog.
file(WRITE "${PROJECT_BINARY_DIR}/copyright"
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: houghstream

Files: *
Copyright: The Houghstream engineers
License: none-chosen
 No licence has been chosen yet. Nobody has been given the right to copy, change
 or distribute this work.
")
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
execute_process(
  COMMAND awk -v "version=${PROJECT_VERSION}" -v "signature=${CPACK_PACKAGE_CONTACT}  ${now}"
          -f "${PROJECT_SOURCE_DIR}/.cmake/debian_changelog.awk" "${PROJECT_SOURCE_DIR}/tools/CHANGELOG.md"
  OUTPUT_FILE "${PROJECT_BINARY_DIR}/changelog" COMMAND_ERROR_IS_FATAL ANY)
find_program(GZIP gzip REQUIRED)
execute_process(COMMAND "${GZIP}" -9nf "${PROJECT_BINARY_DIR}/changelog")
set(documented programs:houghstream development:libhoughstream-dev python:python3-houghstream java:houghstream-java)
if(samples_component)
  list(APPEND documented samples:houghstream-samples)
endif()
foreach(pair IN LISTS documented)
  string(REPLACE ":" ";" pair "${pair}")
  list(GET pair 0 component)
  list(GET pair 1 package)
  install(FILES "${PROJECT_BINARY_DIR}/copyright" "${PROJECT_BINARY_DIR}/changelog.gz"
          DESTINATION "share/doc/${package}" COMPONENT ${component})
endforeach()

# Not a flag of taste: without it g++ 12 sends zeros (compiler_options.cmake).
file(WRITE "${PROJECT_BINARY_DIR}/lintian-overrides" "libhoughstream-dev: pkg-config-bad-directive -fno-strict-aliasing *\n")
install(FILES "${PROJECT_BINARY_DIR}/lintian-overrides" DESTINATION share/lintian/overrides RENAME libhoughstream-dev
        COMPONENT development)

include(CPack)
