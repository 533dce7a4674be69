# What Houghstream is compared with, which tools/demo does without: OpenCV's LINEMOD and surface matching, PCL, Google's
# benchmark library. Sets HOUGHSTREAM_COMPARISONS: whether detector/baseline and tools/studies are built.

include(find_pcl)
find_package(benchmark QUIET)

set(missing)
if(NOT PCL_INCLUDE_DIR)
  list(APPEND missing PCL)
endif()
foreach(library opencv_rgbd opencv_surface_matching benchmark::benchmark)
  if(NOT TARGET ${library})
    list(APPEND missing ${library})
  endif()
endforeach()
set(HOUGHSTREAM_COMPARISONS ON)
if(missing)
  list(JOIN missing ", " missing)
  set(HOUGHSTREAM_COMPARISONS OFF)
  houghstream_summary("comparisons       no (${missing} not found: tools/setup)")
endif()
