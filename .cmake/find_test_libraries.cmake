# What the tests link. Where it is missing HOUGHSTREAM_TESTS is off for this run of CMake, but not in the cache, so that
# the tests are built as soon as it is there; tools/test fails where there are none.

if(HOUGHSTREAM_TESTS)
  find_package(GTest QUIET)
  include(find_matio)
  if(NOT GTest_FOUND OR NOT TARGET houghstream::matio OR NOT HOUGHSTREAM_COMPARISONS)
    set(HOUGHSTREAM_TESTS OFF)
    houghstream_summary("tests             no (GTest, matio or what is compared with not found: tools/setup)")
  endif()
endif()
