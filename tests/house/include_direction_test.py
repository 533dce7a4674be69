"""Plants wrong includes in a small copy of the house and expects each to be found."""

import unittest

import include_direction
import seeded_faults

GOOD = {
    "pipeline/CMakeLists.txt": "houghstream_library(pipeline SOURCES types/frame.cpp LINK x)\n"
    "houghstream_library(pipeline_lcm SOURCES messages.cpp LINK x)\n",
    "pipeline/types/frame.hpp": "#pragma once\n#include <vector>\n",
    "pipeline/types/frame.cpp": '#include "pipeline/types/frame.hpp"\n',
    "pipeline/messages/messages.hpp": '#include <houghstream/images_t.hpp>\n#include "pipeline/types/frame.hpp"\n',
    "pipeline/messages.cpp": '#include "pipeline/messages/messages.hpp"\n#include <lcm/lcm-cpp.hpp>\n',
    "drivers/camera.cpp": '#include <OpenNI.h>\n#include "pipeline/types/frame.hpp"\n',
    "pose/icp.hpp": "#pragma once\n",
    "pose/baseline/icp.cpp": "#include <pcl/registration/icp.h>\n",
    "tools/view/main.cpp": '#include <lcm/lcm-cpp.hpp>\n#include "detector/surface.hpp"\n',
    "tests/pose/icp_test.cpp": '#include "pose/icp.hpp"\n#include "tools/view/drawing/overlay.hpp"\n',
}

WRONG = {
    "pipeline/types/frame.cpp": '#include "pose/icp.hpp"\n',
    "drivers/camera.cpp": '#include "detector/detector.hpp"\n',
    "detector/detector.cpp": '#include "tools/view/drawing/overlay.hpp"\n',
    "pose/icp.cpp": '#  include "drivers/camera.hpp"\n',
    "tools/view/main.cpp": '#include "tests/helpers.hpp"\n',
    "detector/stream.cpp": "#include <lcm/lcm-cpp.hpp>\n",
    "drivers/log.cpp": '#include "pipeline/messages/messages.hpp"\n',
    "pipeline/types/frame.hpp": '#include "pipeline/messages/messages.hpp"\n',
}


def faults_with(extra):
    return seeded_faults.faults_of({**GOOD, **extra}, include_direction.find_faults)


class IncludeDirection(unittest.TestCase):
    def test_a_tidy_house_has_no_fault(self):
        self.assertEqual(faults_with({}), [])

    def test_every_planted_fault_is_found_and_named(self):
        for name, text in WRONG.items():
            with self.subTest(file=name):
                faults = faults_with({name: text})
                self.assertTrue(any(name in fault for fault in faults), faults)


if __name__ == "__main__":
    unittest.main()
