# What the program is built of: `fppg -ver` prints it as it is loaded, fppg.spdx.json lists it as it
# was built with (SPDX 2.3; made without network, installed beside the licence).
set(hdf5_version "")
if(TARGET fppg_hdf5)
  file(STRINGS ${FPPG_HDF5_INCLUDES}/H5public.h lines REGEX "^#define H5_VERS_(MAJOR|MINOR|RELEASE) +[0-9]+")
  list(TRANSFORM lines REPLACE "^#define H5_VERS_[A-Z]+ +([0-9]+).*" "\\1" OUTPUT_VARIABLE hdf5_version)
  list(JOIN hdf5_version . hdf5_version)
  set_source_files_properties(${PROJECT_SOURCE_DIR}/src/app/build_facts.cpp TARGET_DIRECTORY fppg_lib
      PROPERTIES COMPILE_DEFINITIONS "FPPG_HDF5_VERSION=\"${hdf5_version}\"")
endif()
execute_process(COMMAND getconf GNU_LIBC_VERSION OUTPUT_VARIABLE glibc OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
string(REGEX MATCH "[0-9.]+$" glibc "${glibc}")
set(loaded "dynamically linked")
set(link DYNAMIC_LINK)
set(c_library "glibc|${glibc}|LGPL-2.1-or-later|DYNAMIC_LINK|${loaded}: libc, libm, ld-linux")
if(WIN32)
  set(loaded "statically linked")
  set(link STATIC_LINK)
  set(c_library "mingw-w64||ZPL-2.1|STATIC_LINK|${loaded}: its runtime and libwinpthread, beside msvcrt.dll of Windows")
endif()
if(FPPG_LIBGOMP_IS_INSIDE)
  set(gomp "of it libgomp is inside the program, the rest dynamically linked")
else()
  set(gomp ${loaded})
endif()

find_package(nlohmann_json QUIET)
# name|version|licence|relationship|how, and which libraries of it
set(materials
    "fmt|${fmt_VERSION}|MIT|${link}|${loaded}: libfmt"
    "tinyxml2|${tinyxml2_VERSION}|Zlib|${link}|${loaded}: libtinyxml2"
    "embree|${embree_VERSION}|Apache-2.0|${link}|${loaded}: libembree3 or libembree4"
    "libpng|${PNG_VERSION_STRING}|libpng-2.0|${link}|${loaded}: libpng16"
    "zlib|${ZLIB_VERSION_STRING}|Zlib|${link}|${loaded}: libz"
    "gcc-runtime|${CMAKE_CXX_COMPILER_VERSION}|GPL-3.0-or-later WITH GCC-exception-3.1|${link}|libstdc++, libgcc_s, libgomp (${gomp})"
    "${c_library}"
    "CLI11|${CLI11_VERSION}|BSD-3-Clause|CONTAINS|headers"
    "nlohmann_json|${nlohmann_json_VERSION}|MIT|CONTAINS|headers")
if(hdf5_version)
  list(APPEND materials "hdf5|${hdf5_version}||OPTIONAL_COMPONENT_OF|${loaded} in the plugin libfppg_hdf5.so: libhdf5")
endif()
if(TARGET fppg_python)
  list(APPEND materials "pybind11|${FPPG_PYBIND11_VERSION}|BSD-3-Clause|CONTAINS|headers, in the Python module")
endif()
file(READ ${PROJECT_SOURCE_DIR}/src/report/web/package-lock.json lock)
string(JSON three_version GET "${lock}" packages node_modules/three version)
list(APPEND materials
    "three.js|${three_version}|MIT|CONTAINS|in the script of report pages, where npm was there (else the system's libjs-three, or none)")

# A package of the bill; with a relationship to the program.
set(bill_packages "")
set(bill_relations "")
function(add_to_bill name version licence relation note)
  foreach(value IN ITEMS version licence)
    if("${${value}}" STREQUAL "")
      set(${value} NOASSERTION)
    endif()
  endforeach()
  set(comma "")
  if(bill_packages)
    set(comma ",\n")
  endif()
  string(REPLACE "_" "-" id SPDXRef-${name})
  string(APPEND bill_packages "${comma}    {
      \"SPDXID\": \"${id}\",
      \"name\": \"${name}\",
      \"versionInfo\": \"${version}\",
      \"downloadLocation\": \"NOASSERTION\",
      \"filesAnalyzed\": false,
      \"licenseConcluded\": \"NOASSERTION\",
      \"licenseDeclared\": \"${licence}\",
      \"copyrightText\": \"NOASSERTION\",
      \"comment\": \"${note}\"
    }")
  if(relation STREQUAL OPTIONAL_COMPONENT_OF)
    set(relation "\"${id}\", \"relationshipType\": \"${relation}\", \"relatedSpdxElement\": \"SPDXRef-fppg\"")
  else()
    set(relation "\"SPDXRef-fppg\", \"relationshipType\": \"${relation}\", \"relatedSpdxElement\": \"${id}\"")
  endif()
  if(NOT name STREQUAL fppg)
    string(APPEND bill_relations ",\n    { \"spdxElementId\": ${relation} }")
  endif()
  set(bill_packages "${bill_packages}" PARENT_SCOPE)
  set(bill_relations "${bill_relations}" PARENT_SCOPE)
endfunction()
add_to_bill(fppg "${PROJECT_VERSION}" Apache-2.0 ""
    "commit @COMMIT@, built by ${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
foreach(material IN LISTS materials)
  string(REPLACE "|" ";" fields "${material}")
  list(GET fields 0 name)
  list(GET fields 1 version)
  list(GET fields 2 licence)
  list(GET fields 3 relation)
  list(GET fields 4 note)
  add_to_bill(${name} "${version}" "${licence}" ${relation} "${note}")
endforeach()

set(sheet ${PROJECT_BINARY_DIR}/fppg.spdx.json.in)
set(bill ${PROJECT_BINARY_DIR}/fppg.spdx.json)
# @COMMIT@ and @CREATED@ are of each build, not of its configuration.
file(GENERATE OUTPUT ${sheet} CONTENT "{
  \"spdxVersion\": \"SPDX-2.3\",
  \"dataLicense\": \"CC0-1.0\",
  \"SPDXID\": \"SPDXRef-DOCUMENT\",
  \"name\": \"fppg-${PROJECT_VERSION}\",
  \"documentNamespace\": \"https://spdx.org/spdxdocs/fppg-${PROJECT_VERSION}-@COMMIT@\",
  \"creationInfo\": { \"created\": \"@CREATED@\", \"creators\": [ \"Tool: fppg-build\" ] },
  \"packages\": [
${bill_packages}
  ],
  \"relationships\": [
    { \"spdxElementId\": \"SPDXRef-DOCUMENT\", \"relationshipType\": \"DESCRIBES\", \"relatedSpdxElement\": \"SPDXRef-fppg\" }${bill_relations}
  ]
}
")

set(commit_code ${PROJECT_BINARY_DIR}/build_commit.cpp)
add_custom_target(fppg_build_facts
  BYPRODUCTS ${commit_code} ${bill}
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DSHEET=${sheet} -DBILL=${bill}
    -DCODE=${commit_code} -P ${PROJECT_SOURCE_DIR}/tools/cmake/build_facts.cmake
  VERBATIM)
target_sources(fppg_lib PRIVATE ${commit_code})
add_dependencies(fppg_lib fppg_build_facts)
install(FILES ${bill} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/fppg COMPONENT fppg)
