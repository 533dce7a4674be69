# matio writes the MATLAB files that the tests read. Gives the target houghstream::matio.

find_path(MATIO_INCLUDE_DIR matio.h REQUIRED)
find_library(MATIO_LIBRARY matio REQUIRED)
add_library(houghstream::matio UNKNOWN IMPORTED)
set_target_properties(houghstream::matio PROPERTIES IMPORTED_LOCATION "${MATIO_LIBRARY}"
                                                    INTERFACE_INCLUDE_DIRECTORIES "${MATIO_INCLUDE_DIR}")
