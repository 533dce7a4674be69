# In place of RealSense's SDK, which Debian 12 has not: what the example takes of it, and a camera of ten frames.
add_library(realsense2::realsense2 INTERFACE IMPORTED)
set_target_properties(realsense2::realsense2 PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${CMAKE_CURRENT_LIST_DIR}")
