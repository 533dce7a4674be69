# What is installed, where the GNU directories want it, in components that become Debian packages (packages.cmake):
# programs, development, python, java, samples.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(shared_data "${CMAKE_INSTALL_DATADIR}/houghstream")

# Programs
set(programs hs-capture hs-detect hs-pose hs-view hs-log hs-stream hs-doctor hs-teach hs-train hs-fuse hs-evaluate
             hs-import hs-render hs-observe hs-track)
install(TARGETS ${programs} RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT programs)
install(PROGRAMS "${PROJECT_BINARY_DIR}/bin/hs-spy" "${PROJECT_SOURCE_DIR}/tools/houghstream-demo"
        DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT programs)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/tools/studies" DESTINATION "${shared_data}" COMPONENT programs
        FILES_MATCHING PATTERN "*.py" PATTERN "*.html" PATTERN "__pycache__" EXCLUDE)
install(FILES "${PROJECT_SOURCE_DIR}/README.md" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT programs)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/tools/stream/systemd/" DESTINATION lib/systemd/user COMPONENT programs
        FILES_MATCHING PATTERN "*.service" PATTERN "*.target")
install(FILES "${PROJECT_SOURCE_DIR}/tools/stream/systemd/houghstream.env"
              "${PROJECT_SOURCE_DIR}/tools/stream/houghstream.pmd"
        DESTINATION "${CMAKE_INSTALL_DOCDIR}/examples" COMPONENT programs)

# The virtual camera: LD_LIBRARY_PATH of its folder makes programs see it.
set(virtual_camera "${CMAKE_INSTALL_LIBDIR}/houghstream/virtual_camera")
install(TARGETS virtual_camera LIBRARY DESTINATION "${virtual_camera}/OpenNI2/Drivers" COMPONENT programs)
install(FILES "${PROJECT_BINARY_DIR}/virtual_camera/libOpenNI2.so.0" DESTINATION "${virtual_camera}" COMPONENT programs)
install(FILES "${PROJECT_BINARY_DIR}/virtual_camera/OpenNI2/Drivers/libOniFile.so.0"
        DESTINATION "${virtual_camera}/OpenNI2/Drivers" COMPONENT programs)

# Manual pages and completions are made of --help. Scripts are files, all others targets.
find_program(HELP2MAN help2man)
set(manual "${PROJECT_BINARY_DIR}/man")
set(pages)
set(hs-spy_script "${PROJECT_BINARY_DIR}/bin/hs-spy")
set(houghstream-demo_script "${PROJECT_SOURCE_DIR}/tools/houghstream-demo")
foreach(program IN LISTS programs ITEMS hs-spy houghstream-demo)
  install(FILES "${PROJECT_SOURCE_DIR}/tools/stream/bash_completion" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions"
          RENAME "${program}" COMPONENT programs)
  if(HELP2MAN AND NOT HOUGHSTREAM_SANITIZE) # a leak of a library would fail --help
    set(made_of ${program})
    set(told_by "$<TARGET_FILE:${program}>")
    if(DEFINED ${program}_script)
      set(made_of "${${program}_script}")
      set(told_by "${made_of}")
    endif()
    add_custom_command(OUTPUT "${manual}/${program}.1.gz" DEPENDS "${made_of}" "${PROJECT_SOURCE_DIR}/.cmake/manual_page.sh"
      COMMAND "${CMAKE_COMMAND}" -E env PYTHONDONTWRITEBYTECODE=1 "HELP2MAN=${HELP2MAN}"
              sh "${PROJECT_SOURCE_DIR}/.cmake/manual_page.sh" "${told_by}" "${PROJECT_VERSION}" "${manual}/${program}.1.gz"
      VERBATIM)
    list(APPEND pages "${manual}/${program}.1.gz")
  endif()
endforeach()
if(pages)
  add_custom_target(houghstream_manual ALL DEPENDS ${pages})
  install(FILES ${pages} DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT programs)
else()
  houghstream_summary("manual pages      no (help2man not found)")
endif()

# Libraries and headers
set_target_properties(lcmtypes PROPERTIES EXPORT_NAME types)
install(TARGETS ${HOUGHSTREAM_LIBRARIES} EXPORT houghstream_targets
        ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development
        INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" "${CMAKE_INSTALL_INCLUDEDIR}/houghstream")
install(DIRECTORY "${PROJECT_BINARY_DIR}/lcmtypes/generated/houghstream" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
        COMPONENT development FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/lcmtypes/" DESTINATION "${shared_data}/lcmtypes" COMPONENT development
        FILES_MATCHING PATTERN "*.lcm")
file(STRINGS "${PROJECT_SOURCE_DIR}/.cmake/public_headers.txt" moved_headers REGEX "^[a-z].* = ")
foreach(line IN LISTS moved_headers)
  string(REGEX REPLACE "^(.*) = (.*)$" "\\1;\\2" names "${line}")
  list(GET names 0 old)
  list(GET names 1 new)
  get_filename_component(folder "${old}" DIRECTORY)
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/moved_headers/${old}" @ONLY
       CONTENT "#pragma once\n\n// This header has moved; its old name goes with the next release.\n#include \"${new}\"\n")
  install(FILES "${PROJECT_BINARY_DIR}/moved_headers/${old}"
          DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/houghstream/${folder}" COMPONENT development)
endforeach()
file(STRINGS "${PROJECT_SOURCE_DIR}/.cmake/public_headers.txt" headers REGEX "^[a-z][^=]*$")
foreach(header IN LISTS headers)
  get_filename_component(folder "${header}" DIRECTORY)
  install(FILES "${PROJECT_SOURCE_DIR}/${header}" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/houghstream/${folder}"
          COMPONENT development)
endforeach()

find_program(DOXYGEN doxygen)
if(DOXYGEN)
  list(TRANSFORM headers PREPEND "${PROJECT_SOURCE_DIR}/" OUTPUT_VARIABLE api_headers)
  list(TRANSFORM api_headers REPLACE "(.+)" "\"\\1\"")
  list(JOIN api_headers " " api_headers)
  configure_file("${PROJECT_SOURCE_DIR}/.cmake/Doxyfile.in" "${PROJECT_BINARY_DIR}/Doxyfile" @ONLY)
  add_custom_target(houghstream_api COMMAND "${DOXYGEN}" "${PROJECT_BINARY_DIR}/Doxyfile" VERBATIM)
endif()

set(cmake_folder "${CMAKE_INSTALL_LIBDIR}/cmake/houghstream")
install(EXPORT houghstream_targets NAMESPACE houghstream:: DESTINATION "${cmake_folder}" COMPONENT development)
configure_package_config_file("${PROJECT_SOURCE_DIR}/.cmake/houghstreamConfig.cmake.in" "${PROJECT_BINARY_DIR}/houghstreamConfig.cmake"
                              INSTALL_DESTINATION "${cmake_folder}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/houghstreamConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/houghstreamConfig.cmake" "${PROJECT_BINARY_DIR}/houghstreamConfigVersion.cmake"
              "${PROJECT_SOURCE_DIR}/.cmake/find_lcm.cmake"
        DESTINATION "${cmake_folder}" COMPONENT development)
file(RELATIVE_PATH pc_prefix "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/") # wherever it is installed
configure_file("${PROJECT_SOURCE_DIR}/.cmake/houghstream.pc.in" "${PROJECT_BINARY_DIR}/houghstream.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/houghstream.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT development)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/tools/examples/" DESTINATION share/doc/libhoughstream-dev/examples
        COMPONENT development USE_SOURCE_PERMISSIONS PATTERN "README.md" EXCLUDE)

# Python and Java
# Debian's Python looks in lib/python3 below /usr, and in the folder of its own version elsewhere. Which prefix it is, is known
# only when it is installed; cpack's ends with /usr too.
install(CODE "
  set(python_folder lib/python3)
  if(NOT CMAKE_INSTALL_PREFIX MATCHES \"/usr/?$\")
    execute_process(COMMAND /usr/bin/python3 -c \"import sys; print('lib/python%d.%d' % sys.version_info[:2])\"
                    OUTPUT_VARIABLE python_folder OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  endif()
  set(package \"\${CMAKE_INSTALL_PREFIX}/\${python_folder}/dist-packages\")
  file(INSTALL \"${PROJECT_BINARY_DIR}/python/houghstream\" DESTINATION \"\${package}\"
       FILES_MATCHING PATTERN \"*.py\" PATTERN \"*.pyi\" PATTERN \"py.typed\" PATTERN \"*.so\" PATTERN \"__pycache__\" EXCLUDE)
  file(GLOB modules \"\$ENV{DESTDIR}\${package}/houghstream/*.so\")
  if(modules AND CMAKE_INSTALL_DO_STRIP)
    execute_process(COMMAND \"${CMAKE_STRIP}\" --strip-unneeded \${modules} COMMAND_ERROR_IS_FATAL ANY)
  endif()
" COMPONENT python)
if(TARGET houghstream_types_jar)
  install(FILES "${PROJECT_BINARY_DIR}/bin/houghstream_types.jar" "${PROJECT_BINARY_DIR}/bin/houghstream_spy.jar"
          DESTINATION "${CMAKE_INSTALL_DATADIR}/java" COMPONENT java)
endif()

include(samples)
include(packages)
