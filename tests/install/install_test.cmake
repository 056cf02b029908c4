# Installs the build in BUILD_DIR below WORK_DIR and builds and runs the project in CONSUMER_DIR
# against what was installed.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE text ERROR_VARIABLE text RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command} failed with ${result}:\n${text}")
  endif()
  set(text "${text}" PARENT_SCOPE)
endfunction()

function(expect_text part)
  string(FIND "${text}" "${part}" position)
  if(position EQUAL -1)
    message(FATAL_ERROR "Expected \"${part}\" in \"${text}\"")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --config ${CONFIG} --prefix ${WORK_DIR}/prefix)

# A library built with sanitizers needs their runtime in the program that links it.
set(flags)
if(SANITIZE)
  set(flags -DCMAKE_CXX_FLAGS=-fsanitize=${SANITIZE})
endif()
run(${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${WORK_DIR}/build -G Ninja -DCMAKE_BUILD_TYPE=${CONFIG}
    -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DREADME=${README} ${flags})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${CMAKE_COMMAND} -E chdir ${WORK_DIR} build/consumer ${CASE})
expect_text("21001 particles, 20000 of fluid")
if(NOT EXISTS ${WORK_DIR}/particles.vtu)
  message(FATAL_ERROR "The program wrote no particles.vtu")
endif()

if(HAS_PROGRAM)
  run(${WORK_DIR}/prefix/bin/fppg -h)
endif()
