# PCL's headers and single libraries, found directly: PCL's own CMake package also asks for VTK, Qt and MPI, which
# nothing here uses.

find_path(PCL_INCLUDE_DIR pcl/registration/icp.h PATH_SUFFIXES pcl-1.15 pcl-1.14 pcl-1.13 pcl-1.12)

# houghstream_use_pcl(target part...): the target's own sources see PCL's headers and link pcl_<part>.
function(houghstream_use_pcl target)
  target_include_directories(${target} SYSTEM PRIVATE "${PCL_INCLUDE_DIR}")
  foreach(part IN LISTS ARGN)
    find_library(PCL_${part}_LIBRARY pcl_${part} REQUIRED)
    target_link_libraries(${target} PRIVATE "${PCL_${part}_LIBRARY}")
  endforeach()
endfunction()
