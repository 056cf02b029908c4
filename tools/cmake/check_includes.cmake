# Checks that includes point downwards only.
#
#   cmake -DSOURCE_DIR=<repository> -P check_includes.cmake
#
# Every folder of src/ may include itself and the folders listed for it here; folders that do not
# list one another do not know one another. `platform` may be seen by all. The plain structs of include/fppg/ may be seen by all
# but include only each other. Stops with a list of the files and folders at fault.
cmake_minimum_required(VERSION 3.25)

# All that differs between systems.
set(platform_may_see)
set(core_may_see)
set(report_may_see core)
# Runs of nodes and their sets.
set(nodes_may_see core)
# Mesh files, read, mended and asked.
set(meshes_may_see nodes core)
# Depths behind surfaces, and the surfaces at a depth.
set(offset_may_see meshes nodes core)
# What can be drawn: what bounds it, its surface, its polygons.
set(shapes_may_see meshes nodes core)
set(casedef_may_see shapes meshes core)
# What a case draws, as all stages below see it.
set(scene_may_see casedef shapes meshes nodes core)
set(particles_may_see offset meshes nodes core)
foreach(folder fit normals files)
  set(${folder}_may_see casedef shapes offset meshes particles nodes core)
endforeach()
set(lattice_may_see offset scene casedef shapes meshes particles nodes core)
# Parts have an inside where walls have one.
set(boolean_may_see fit meshes particles nodes core)
# Relaxation fills the holes that open as fitting does.
set(relax_may_see fit offset casedef shapes meshes particles nodes core)
# Body-fitted shapes and combinations of a scene; what they leave of it is painted on the lattice.
set(walls_may_see boolean fit offset lattice scene casedef shapes meshes particles nodes core)
# Fluid at rest, by the solver's own equations.
set(balance_may_see relax fit offset casedef shapes meshes particles nodes core)
set(render_may_see files particles shapes meshes core)
# What differs in Case.xml is found in its tree, which casedef reads.
set(compare_may_see report files casedef particles shapes meshes core)
# Cases beforehand and many at a time.
set(batch_may_see report balance walls lattice scene files casedef shapes meshes particles nodes core)
# What the solver made of a case, against the true shapes of its draws.
set(leak_may_see walls lattice scene files casedef shapes meshes particles nodes core)
# A written case, judged as the solver would.
set(check_may_see report files casedef particles shapes meshes core)
# Particles in the files of other codes.
set(convert_may_see files casedef particles shapes meshes core)
# The text of a definition, in newer forms.
set(upgrade_may_see core)
# How near parts come to each other, by their true shapes.
set(gaps_may_see leak walls lattice scene files casedef particles shapes meshes nodes core)
# The plugin that reads STEP files sees only what the program and it agree on.
set(step_may_see meshes)
# From parts to a definition.
set(newcase_may_see shapes meshes nodes core)
set(app_may_see newcase gaps convert upgrade check leak batch report compare render walls lattice fit boolean relax balance normals files scene casedef shapes meshes
    particles nodes core)
set(main_may_see app)

# Public headers with functions of a stage: only who may see its folder includes them.
set(fit_headers fit one_sheet section exclusion_band)
set(boolean_headers boolean)
set(relax_headers relax relax_volume relax_walls fit_mesh)
set(balance_headers balance)
set(compare_headers compare)
set(render_headers render)
set(check_headers check)
set(convert_headers convert)
set(newcase_headers new_case)
set(gaps_headers motion_gaps)

# Third parties that few folders wrap for all others.
set(wrapped_libraries tinyxml2 embree png zlib CLI nlohmann)
# This file alone asks all of them for their versions.
set(asks_all src/app/build_facts.cpp)
# The case definition, and mesh files whose numbers are too many to pass through a tree.
set(tinyxml2_may_be_seen_by casedef meshes)
set(zlib_may_be_seen_by meshes)
set(embree_may_be_seen_by meshes render)
set(png_may_be_seen_by render)
set(CLI_may_be_seen_by app)
set(nlohmann_may_be_seen_by core)

# Headers of systems, by their beginnings: the rest of the code runs on all of them.
set(system_headers unistd[.]h sys/ fcntl[.]h dlfcn[.]h dirent[.]h sched[.]h pthread[.]h poll[.]h
    termios[.]h spawn[.]h pwd[.]h signal[.]h gnu/ linux/ windows[.]h io[.]h process[.]h direct[.]h
    psapi[.]h shellapi[.]h shlobj[.]h)
list(JOIN system_headers "|" system_headers)

set(faults)

function(check_file file folder)
  set(found ${faults})
  file(STRINGS ${SOURCE_DIR}/${file} lines REGEX "^[ \t]*#[ \t]*include")
  foreach(line IN LISTS lines)
    if(line MATCHES "include[ \t]+\"([^/\"]+)/")
      set(seen ${CMAKE_MATCH_1})
      if(folder STREQUAL "include" AND NOT seen STREQUAL "fppg")
        list(APPEND found "${file}: a public header may include only fppg/ and std, not ${seen}/")
      elseif(NOT seen STREQUAL "fppg" AND NOT seen STREQUAL folder AND NOT seen STREQUAL "platform"
             AND NOT seen IN_LIST ${folder}_may_see)
        list(APPEND found "${file}: ${folder} may not include ${seen}/")
      endif()
      if(seen STREQUAL "fppg" AND NOT folder STREQUAL "include")
        string(REGEX REPLACE ".*fppg/([a-z_]+)\\.h.*" "\\1" header "${line}")
        foreach(owner fit boolean relax compare render check convert newcase gaps)
          if(header IN_LIST ${owner}_headers AND NOT folder STREQUAL owner
             AND NOT owner IN_LIST ${folder}_may_see)
            list(APPEND found "${file}: ${folder} may not include fppg/${header}.h of ${owner}")
          endif()
        endforeach()
      endif()
    elseif(line MATCHES "include[ \t]+\"" AND NOT line MATCHES "include[ \t]+\"tinyxml2")
      list(APPEND found "${file}: name the folder of the header: ${line}")
    endif()
    if(line MATCHES "[<\"](${system_headers})" AND NOT folder STREQUAL "platform")
      list(APPEND found "${file}: only platform may include headers of a system: ${line}")
    endif()
    foreach(library IN LISTS wrapped_libraries)
      if(line MATCHES "[<\"]${library}[0-9]*[/.]" AND NOT file STREQUAL asks_all AND NOT folder IN_LIST ${library}_may_be_seen_by)
        list(JOIN ${library}_may_be_seen_by " and " owners)
        list(APPEND found "${file}: only ${owners} may include ${library}")
      endif()
    endforeach()
  endforeach()
  set(faults "${found}" PARENT_SCOPE)
endfunction()

file(GLOB_RECURSE files RELATIVE ${SOURCE_DIR} ${SOURCE_DIR}/src/*.h ${SOURCE_DIR}/src/*.cpp
    ${SOURCE_DIR}/include/*.h ${SOURCE_DIR}/include/*.h.in)
foreach(file IN LISTS files)
  if(file MATCHES "^include/")
    set(folder include)
  elseif(file MATCHES "^src/([^/]+)/")
    set(folder ${CMAKE_MATCH_1})
  else()
    set(folder main)
  endif()
  if(folder STREQUAL "include" OR DEFINED ${folder}_may_see OR folder MATCHES "^(core|platform)$")
    check_file(${file} ${folder})
  else()
    list(APPEND faults "${file}: ${folder} has no place among the layers")
  endif()
endforeach()

if(faults)
  list(JOIN faults "\n  " text)
  message(FATAL_ERROR "Includes that do not point downwards:\n  ${text}")
endif()
list(LENGTH files count)
message(STATUS "The includes of ${count} files point downwards")
