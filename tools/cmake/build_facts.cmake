# Writes what a build is made of: a C++ file with the commit, for `fppg -ver`, and the bill of
# materials. Each is written only where it changes.
#
#   cmake -DSOURCE=FOLDER -DSHEET=FILE -DBILL=FILE -DCODE=FILE -P build_facts.cmake
#
# SHEET  of tools/cmake/materials.cmake: the bill but for @COMMIT@ and @CREATED@
cmake_policy(VERSION 3.25)
set(COMMIT unknown)
string(TIMESTAMP CREATED "%Y-%m-%dT%H:%M:%SZ" UTC)
find_program(git git)
if(git AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${git} -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
      OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE code)
  # The same commit gives the same bytes.
  execute_process(COMMAND ${CMAKE_COMMAND} -E env TZ=UTC ${git} -C ${SOURCE} show -s --format=%cd
      --date=format-local:%Y-%m-%dT%H:%M:%SZ
      OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(code EQUAL 0)
    set(COMMIT ${commit})
    if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})
      set(CREATED ${date})
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${CODE} @ONLY CONTENT "// Written by build_facts.cmake.
namespace fppg
{
extern const char* const build_commit;
const char* const build_commit = \"@COMMIT@\";
} // namespace fppg
")
configure_file(${SHEET} ${BILL} @ONLY)
