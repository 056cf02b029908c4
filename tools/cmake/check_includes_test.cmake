# Checks check_includes.cmake on a small tree with one fault of each kind, and without them.
#
#   cmake -DWORK_DIR=<empty folder to write into> -P check_includes_test.cmake
cmake_minimum_required(VERSION 3.25)

function(run_check out)
  execute_process(COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${WORK_DIR} -P
      ${CMAKE_CURRENT_LIST_DIR}/check_includes.cmake ERROR_VARIABLE text OUTPUT_QUIET)
  string(REGEX REPLACE "[ \n]+" " " text "${text}")
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
file(WRITE ${WORK_DIR}/src/main.cpp "#include \"app/run.h\"\n")
file(WRITE ${WORK_DIR}/src/shapes/a.cpp "#include \"core/a.h\"\n#include <embree3/rtcore.h>\n")
file(WRITE ${WORK_DIR}/src/casedef/a.cpp "#include <tinyxml2.h>\n#include \"fppg/vec.h\"\n")
file(WRITE ${WORK_DIR}/src/lattice/a.cpp "#include \"shapes/a.h\"\n#include <vector>\n")
file(WRITE ${WORK_DIR}/include/fppg/a.h "#include \"fppg/vec.h\"\n")
run_check(text)
if(text)
  message(FATAL_ERROR "A tree in order is refused: ${text}")
endif()

function(expect_fault file line expected)
  file(WRITE ${WORK_DIR}/${file} "${line}\n")
  run_check(text)
  file(REMOVE ${WORK_DIR}/${file})
  string(FIND "${text}" "${file}: ${expected}" position)
  if(position EQUAL -1)
    message(FATAL_ERROR "${line} in ${file}: expected \"${expected}\", got \"${text}\"")
  endif()
endfunction()

expect_fault(src/core/b.cpp "#include \"shapes/a.h\"" "core may not include shapes/")
expect_fault(src/files/b.cpp "#include \"lattice/a.h\"" "files may not include lattice/")
expect_fault(src/shapes/b.h "#include \"casedef/a.h\"" "shapes may not include casedef/")
expect_fault(src/main_b.cpp "#include \"core/a.h\"" "main may not include core/")
expect_fault(src/files/b.cpp "#include <tinyxml2.h>" "only casedef may include tinyxml2")
expect_fault(src/files/b.cpp "#include \"tinyxml2.h\"" "only casedef may include tinyxml2")
expect_fault(src/relax/b.cpp "#include <embree3/rtcore.h>" "only shapes may include embree")
expect_fault(src/files/b.cpp "#include \"b.h\"" "name the folder of the header")
expect_fault(src/other/b.cpp "" "other has no place among the layers")
expect_fault(include/fppg/b.h "#include \"core/a.h\"" "a public header may include only fppg/")
