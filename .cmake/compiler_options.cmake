# One place for how our code is compiled: C++17, warnings are errors, one floating-point result on every machine.
# As a part of another project (add_subdirectory, FetchContent) it leaves that one's folders, build type and warnings alone.

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")

if(NOT CMAKE_BUILD_TYPE AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER sh "${PROJECT_SOURCE_DIR}/.cmake/cached_compile.sh" "${CCACHE_PROGRAM}")
endif()

if(PROJECT_IS_TOP_LEVEL)
  set(HOUGHSTREAM_WERROR -Werror)
endif()

set(HOUGHSTREAM_SUMMARY "" CACHE INTERNAL "")
function(houghstream_summary line)
  set(HOUGHSTREAM_SUMMARY "${HOUGHSTREAM_SUMMARY};${line}" CACHE INTERNAL "")
endfunction()

function(houghstream_print_summary)
  message(STATUS "Houghstream ${PROJECT_VERSION}, ${CMAKE_BUILD_TYPE}")
  foreach(line IN LISTS HOUGHSTREAM_SUMMARY)
    if(line)
      message(STATUS "  ${line}")
    endif()
  endforeach()
endfunction()

# Our targets only: generated and third-party headers are system headers.
function(houghstream_compile_options target)
  target_include_directories(${target} PUBLIC "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>")
  # Contraction to fused multiply-add would make results depend on the machine. lcm_coretypes.h reads doubles and floats
  # through integer pointers; optimised under the aliasing rules, g++ 12 drops the stores and sends zeros: all of our code
  # goes without them, as precompiled headers have one set of options.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                                           -Wno-float-conversion ${HOUGHSTREAM_WERROR} -ffp-contract=off -fno-strict-aliasing)
  # A shared library that links ours, as the virtual camera's driver does, exports its own names only.
  target_compile_options(${target} PRIVATE -fvisibility=hidden -fvisibility-inlines-hidden)
  # -O3 takes minutes and gigabytes; GCC 12 sees uninitialised optionals in code that it instruments, where there are none.
  set(sanitized -fno-omit-frame-pointer -g1 $<$<CONFIG:Release>:-O1> -Wno-maybe-uninitialized)
  if(HOUGHSTREAM_FUZZ) # by clang, whose warnings are others
    target_compile_options(${target} PRIVATE -Wno-error -fsanitize=fuzzer-no-link,address,undefined
                                             -fno-sanitize-recover=all -fno-omit-frame-pointer -g)
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
    target_compile_definitions(${target} PRIVATE EIGEN_MALLOC_ALREADY_ALIGNED=1)
  elseif(HOUGHSTREAM_SANITIZE STREQUAL thread)
    target_compile_options(${target} PRIVATE -fsanitize=thread ${sanitized})
    target_link_options(${target} PUBLIC -fsanitize=thread)
  elseif(HOUGHSTREAM_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=address,undefined -fno-sanitize-recover=all ${sanitized})
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
    # Under the address sanitizer Eigen would align its memory itself, and free what PCL's library, which is built
    # without one, has allocated otherwise. The sanitizer's malloc is as aligned as the C library's.
    target_compile_definitions(${target} PRIVATE EIGEN_MALLOC_ALREADY_ALIGNED=1)
  endif()
endfunction()

# Tests hold no hot code of their own; optimising GoogleTest takes a quarter of their build time.
function(houghstream_compile_quickly target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# houghstream_share_headers(NAME [QUICKLY] [RELOCATABLE] HEADERS x ... LINK y ...): what nearly every source includes is
# read once, into the target NAME, and not again by each: a third of the build time. g++ takes the optimisation options of
# the precompiled headers for all that follows: they must be those of the targets that use them. Where
# HOUGHSTREAM_SHARED_HEADERS is off, as for clang-tidy, a source that lives on headers which it does not include itself is
# noticed.
function(houghstream_share_headers name)
  cmake_parse_arguments(ARG "QUICKLY;RELOCATABLE" "" "HEADERS;LINK" ${ARGN})
  if(NOT HOUGHSTREAM_SHARED_HEADERS OR HOUGHSTREAM_FUZZ)
    return()
  endif()
  set(source "${PROJECT_BINARY_DIR}/${name}.cpp")
  file(CONFIGURE OUTPUT "${source}" CONTENT "// ${name}: a target needs a source.\n")
  add_library(${name} OBJECT "${source}")
  target_link_libraries(${name} PRIVATE ${ARG_LINK})
  houghstream_compile_options(${name})
  if(ARG_QUICKLY)
    houghstream_compile_quickly(${name})
  endif()
  if(ARG_RELOCATABLE)
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()

# The target's sources see the headers of houghstream_share_headers(SHARED).
function(houghstream_use_shared_headers target shared)
  if(TARGET ${shared})
    target_precompile_headers(${target} REUSE_FROM ${shared})
  endif()
endfunction()

# With CMAKE_UNITY_BUILD eight sources of a target are compiled as one, which reads their headers once: less time
# where everything is built, more where one source changes. Names of anonymous namespaces are then those of
# the whole target. A source that Highway compiles for each instruction set includes itself and stays alone.
function(houghstream_prepare_unity target)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_filename_component(source "${source}" ABSOLUTE)
    file(STRINGS "${source}" alone REGEX "hwy/foreach_target.h" LIMIT_COUNT 1)
    if(alone)
      set_source_files_properties("${source}" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
  if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL GNU) # which takes a source's own types for those of a header
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
endfunction()

# houghstream_library(NAME [RELOCATABLE] SOURCES a.cpp ... LINK x ...). RELOCATABLE: a shared library may link it, as Python's
# module does.
function(houghstream_library name)
  cmake_parse_arguments(ARG "RELOCATABLE" "" "SOURCES;LINK" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC ${ARG_LINK})
  houghstream_compile_options(${name})
  if(ARG_RELOCATABLE)
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    houghstream_use_shared_headers(${name} relocatable_headers)
  else()
    houghstream_use_shared_headers(${name} library_headers)
  endif()
  houghstream_prepare_unity(${name})
endfunction()

# houghstream_executable(NAME SOURCES a.cpp ... LINK x ...)
function(houghstream_executable name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINK})
  houghstream_compile_options(${name})
  houghstream_use_shared_headers(${name} library_headers)
endfunction()

if(NOT "${HOUGHSTREAM_SANITIZE}" MATCHES "^(|address|thread|OFF)$")
  message(FATAL_ERROR "HOUGHSTREAM_SANITIZE is '${HOUGHSTREAM_SANITIZE}', expected address or thread")
endif()

# For the environment of tests: what libraries never free is not looked for, nor what threads of theirs do. A forest takes
# minutes to train where each of its reads is noted.
set(HOUGHSTREAM_TEST_SECONDS 300)
set(HOUGHSTREAM_LONG_TEST_SECONDS 600)
if(HOUGHSTREAM_SANITIZE STREQUAL thread)
  set(HOUGHSTREAM_TEST_SECONDS 1200)
  set(HOUGHSTREAM_LONG_TEST_SECONDS 2400)
  set(HOUGHSTREAM_SANITIZER_OPTIONS
      "TSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/.cmake/thread_suppressions.txt:print_suppressions=0")
else()
  set(HOUGHSTREAM_SANITIZER_OPTIONS
      "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/.cmake/leak_suppressions.txt:print_suppressions=0")
endif()

# houghstream_tests(NAME FOLDERS x ... LINK y ... [EXCEPT z_test ...]): one GoogleTest program in build/tests of all *_test.cpp
# in the folders below this one, linked once. Each source is a CTest entry, whose suites run in a process of their own.
function(houghstream_tests name)
  cmake_parse_arguments(ARG "" "" "FOLDERS;LINK;EXCEPT" ${ARGN})
  foreach(folder IN LISTS ARG_FOLDERS)
    if(NOT IS_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}/${folder}")
      message(FATAL_ERROR "${name}: no folder ${CMAKE_CURRENT_SOURCE_DIR}/${folder}, expected one with tests")
    endif()
  endforeach()
  list(TRANSFORM ARG_FOLDERS APPEND "/*_test.cpp" OUTPUT_VARIABLE patterns)
  list(TRANSFORM patterns PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  foreach(excepted IN LISTS ARG_EXCEPT)
    list(FILTER sources EXCLUDE REGEX "/${excepted}\\.cpp$")
  endforeach()
  add_executable(${name} ${sources})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} GTest::gtest_main)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests")
  houghstream_compile_options(${name})
  houghstream_compile_quickly(${name})
  houghstream_use_shared_headers(${name} test_headers)
  houghstream_prepare_unity(${name})
  foreach(source IN LISTS sources)
    houghstream_test_entry(${name} "${source}")
  endforeach()
endfunction()

# Which suites a source has is read from it when CMake runs, which it does again when the source changes.
function(houghstream_test_entry program source)
  get_filename_component(entry "${source}" NAME_WE)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${source}")
  file(STRINGS "${source}" heads REGEX "^TEST(_F|_P)?\\(")
  list(TRANSFORM heads REPLACE "^TEST(_F|_P)?\\(([A-Za-z0-9_]+).*" "\\2" OUTPUT_VARIABLE suites)
  list(REMOVE_DUPLICATES suites)
  if(NOT suites)
    message(FATAL_ERROR "${source}: no line that begins with TEST(, TEST_F( or TEST_P(")
  endif()
  list(TRANSFORM suites REPLACE "(.+)" "\\1.*:*/\\1.*")
  list(JOIN suites ":" filter)
  add_test(NAME ${entry} COMMAND ${program} "--gtest_filter=${filter}")
  set_tests_properties(${entry} PROPERTIES TIMEOUT ${HOUGHSTREAM_TEST_SECONDS} ENVIRONMENT "${HOUGHSTREAM_SANITIZER_OPTIONS}")
endfunction()
