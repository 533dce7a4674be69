# What houghstream-demo shows: a fifth package, houghstream-samples, where it has been made. tools/demo makes the data; the target
# `samples` packs them into the build folder, and configures again, so that the package is known.
set(samples "${PROJECT_BINARY_DIR}/samples")
add_custom_target(samples
  COMMAND "${CMAKE_COMMAND}" -E env PYTHONDONTWRITEBYTECODE=1 "PYTHONPATH=${PROJECT_SOURCE_DIR}/tools:${PROJECT_BINARY_DIR}/python"
          /usr/bin/python3 -m studies.demo.samples --programs "${PROJECT_BINARY_DIR}/bin"
          --data "${PROJECT_SOURCE_DIR}/out/demo/data" --out "${samples}"
  COMMAND "${CMAKE_COMMAND}" "${PROJECT_BINARY_DIR}"
  USES_TERMINAL VERBATIM)
add_dependencies(samples hs-capture houghstream_python)
set(samples_component)
if(EXISTS "${samples}/samples.json")
  set(samples_component samples)
  install(DIRECTORY "${samples}/" DESTINATION "${shared_data}/samples" COMPONENT samples)
else()
  houghstream_summary("houghstream-samples no (tools/demo, then cmake --build BUILD -t samples)")
endif()
