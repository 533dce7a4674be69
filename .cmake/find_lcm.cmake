# LCM >= 1.4 brings a CMake package; Debian 12 has 1.3.1, which brings only the library and lcm-gen.
# Gives the target houghstream::lcm, LCM_GEN, and LCM_JAR where Java is usable.

find_package(lcm CONFIG QUIET)
if(TARGET lcm)
  add_library(houghstream::lcm ALIAS lcm)
else()
  find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp REQUIRED)
  find_library(LCM_LIBRARY lcm REQUIRED)
  add_library(houghstream::lcm UNKNOWN IMPORTED)
  set_target_properties(houghstream::lcm PROPERTIES IMPORTED_LOCATION "${LCM_LIBRARY}"
                                                    INTERFACE_INCLUDE_DIRECTORIES "${LCM_INCLUDE_DIR}")
endif()
find_program(LCM_GEN lcm-gen REQUIRED)

find_program(JAVAC javac)
find_program(JAR_TOOL jar)
find_file(LCM_JAR lcm.jar PATHS /usr/share/java /usr/local/share/java)
