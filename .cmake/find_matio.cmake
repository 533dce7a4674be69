# matio writes the MATLAB files that the tests read. Gives the target houghstream::matio, where it is there.

find_path(MATIO_INCLUDE_DIR matio.h)
find_library(MATIO_LIBRARY matio)
if(MATIO_INCLUDE_DIR AND MATIO_LIBRARY)
  add_library(houghstream::matio UNKNOWN IMPORTED)
  set_target_properties(houghstream::matio PROPERTIES IMPORTED_LOCATION "${MATIO_LIBRARY}"
                                                      INTERFACE_INCLUDE_DIRECTORIES "${MATIO_INCLUDE_DIR}")
endif()
