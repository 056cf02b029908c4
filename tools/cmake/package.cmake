# What is installed besides the program and the library, and the packages that cpack makes of it:
# fppg; fppg-gencase-link, a link that lets the program be called as GenCase_linux64; and fppg-step, the
# plugin that reads STEP files, which needs OpenCASCADE and by it some 120 other packages, X11 among them.
#
# `cmake --install` leaves the link out; `cmake --install DIR --component fppg-gencase-link` makes it.
set(packages fppg fppg-gencase-link)
if(TARGET fppg_step)
  list(APPEND packages fppg-step)
endif()
find_program(FPPG_GZIP gzip)
if(FPPG_GZIP)
  set(man_page ${PROJECT_BINARY_DIR}/fppg.1.gz)
  add_custom_command(OUTPUT ${man_page}
    COMMAND ${FPPG_GZIP} -9nc ${PROJECT_SOURCE_DIR}/tools/package/fppg.1 > ${man_page}
    DEPENDS ${PROJECT_SOURCE_DIR}/tools/package/fppg.1 VERBATIM)
  add_custom_target(fppg_man_page ALL DEPENDS ${man_page})
  if(TARGET fppg_cli)
    add_dependencies(fppg_cli fppg_man_page)
  endif()
else()
  set(man_page ${PROJECT_SOURCE_DIR}/tools/package/fppg.1)
endif()
install(FILES ${man_page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT fppg)
install(FILES tools/package/fppg.bash RENAME fppg COMPONENT fppg
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES SECURITY.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/fppg COMPONENT fppg)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/fppg COMPONENT fppg)
install(FILES tools/paraview/fppg_reader.py tools/particle_files.py tools/case_xml.py COMPONENT fppg
    DESTINATION ${CMAKE_INSTALL_DATADIR}/fppg/paraview)
install(FILES tools/python/meshio_bi4.py tools/particle_files.py tools/case_xml.py COMPONENT fppg
    DESTINATION ${CMAKE_INSTALL_DATADIR}/fppg/meshio)
install(DIRECTORY cases DESTINATION ${CMAKE_INSTALL_DATADIR}/fppg COMPONENT fppg
    PATTERN "*_out" EXCLUDE)

set(link ${PROJECT_BINARY_DIR}/gencase-link/GenCase_linux64)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/gencase-link)
file(CREATE_LINK fppg ${link} SYMBOLIC)
install(FILES ${link} DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT fppg-gencase-link
    EXCLUDE_FROM_ALL)

# What Debian asks of a package: its licence, a changelog of its own form, and a word on what its checks
# say that stays: there is no address to write to.
if(FPPG_GZIP)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/changelog CONTENT "fppg (@PROJECT_VERSION@) unstable; urgency=medium

  * CHANGELOG.md has all changes.

 -- The authors of fppg <fppg@localhost>  Thu, 01 Jan 2026 00:00:00 +0000
" @ONLY)
  execute_process(COMMAND ${FPPG_GZIP} -9nc ${PROJECT_BINARY_DIR}/changelog
      OUTPUT_FILE ${PROJECT_BINARY_DIR}/changelog.gz)
endif()
foreach(package IN LISTS packages)
  file(WRITE ${PROJECT_BINARY_DIR}/lintian/${package} "# There is no list to write to.
${package}: bogus-mail-host *
${package}: bogus-mail-host-in-debian-changelog *
")
  set(only_in_package EXCLUDE_FROM_ALL)
  if(package STREQUAL "fppg")
    set(only_in_package)
  endif()
  install(FILES tools/package/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
      COMPONENT ${package} ${only_in_package})
  install(FILES ${PROJECT_BINARY_DIR}/lintian/${package} DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
      COMPONENT ${package} ${only_in_package})
  if(FPPG_GZIP)
    install(FILES ${PROJECT_BINARY_DIR}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
        COMPONENT ${package} ${only_in_package})
  endif()
endforeach()

# Archives are not stripped with the programs; with debug information the library has 400 MB.
install(CODE "if(CMAKE_INSTALL_DO_STRIP)
  execute_process(COMMAND ${CMAKE_STRIP} --strip-debug
    \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/libfppg.a\")
endif()" COMPONENT fppg)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME fppg)
set(CPACK_PACKAGE_VENDOR fppg)
set(CPACK_PACKAGE_CONTACT "The authors of fppg <fppg@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL ${packages})
set(CPACK_COMPONENTS_IGNORE_GROUPS ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FPPG_PACKAGE_NAME fppg)
# Of the Python module and the plugin for ParaView.
set(CPACK_DEBIAN_FPPG_PACKAGE_RECOMMENDS "python3, python3-numpy")
set(CPACK_COMPONENT_FPPG_DESCRIPTION "SPH particles on the lattice or body-fitted
The program, its library with headers and CMake package, case templates
and cases. It reads the case definitions of DualSPHysics' GenCase.")
find_program(FPPG_SHLIBDEPS dpkg-shlibdeps)
if(FPPG_SHLIBDEPS)
  set(CPACK_DEBIAN_FPPG_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_FPPG-STEP_PACKAGE_SHLIBDEPS ON)
endif()
set(CPACK_DEBIAN_FPPG_PACKAGE_SUGGESTS fppg-step)
set(CPACK_DEBIAN_FPPG-STEP_PACKAGE_NAME fppg-step)
set(CPACK_DEBIAN_FPPG-STEP_PACKAGE_DEPENDS "fppg (= ${PROJECT_VERSION})")
set(CPACK_COMPONENT_FPPG-STEP_DESCRIPTION "fppg's plugin for STEP files
With it fppg draws and body-fits CAD models in STEP files, by OpenCASCADE.")
set(CPACK_DEBIAN_FPPG-GENCASE-LINK_PACKAGE_NAME fppg-gencase-link)
set(CPACK_DEBIAN_FPPG-GENCASE-LINK_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_FPPG-GENCASE-LINK_PACKAGE_DEPENDS fppg)
set(CPACK_COMPONENT_FPPG-GENCASE-LINK_DESCRIPTION "fppg in the place of GenCase
A link by which scripts that call GenCase_linux64 get fppg.")
include(CPack)
