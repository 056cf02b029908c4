# Bundles web/viewer.js with three.js into one script and writes it as a C++ source:
#   cmake -DWEB=DIR -DWORK=DIR -DOUTPUT=x.cpp -DSOURCE=auto|npm|debian|none -DNPM=npm
#         -DESBUILD=esbuild -DTHREE=DIR -P bundle_viewer.cmake
# With SOURCE=auto a way that fails is followed by the next one; with npm or debian it is an error.
cmake_minimum_required(VERSION 3.25)

set(options --bundle --minify --format=iife --charset=ascii --legal-comments=inline
    --log-level=warning --outfile=${WORK}/bundle.js)
set(reasons)

function(bundle way)
  execute_process(COMMAND ${ARGN} ${options} WORKING_DIRECTORY ${WORK} TIMEOUT 120
      RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(result EQUAL 0 AND EXISTS ${WORK}/bundle.js)
    set(is_done TRUE PARENT_SCOPE)
    message(STATUS "3-D view of report pages: bundled with three.js of ${way}")
  else()
    set(reasons ${reasons} "${way}: esbuild failed: ${text}" PARENT_SCOPE)
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
file(COPY ${WEB}/viewer.js ${WEB}/package.json ${WEB}/package-lock.json DESTINATION ${WORK})
set(is_done FALSE)

if(SOURCE MATCHES "auto|npm")
  if(NPM)
    # No retries: where the registry cannot be reached, the next way is taken at once.
    execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline
          --fetch-retries=0 --fetch-timeout=30000
        WORKING_DIRECTORY ${WORK} TIMEOUT 180
        RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
    if(result EQUAL 0)
      bundle(npm ${WORK}/node_modules/.bin/esbuild viewer.js)
    else()
      list(APPEND reasons "npm: npm ci failed (${result})")
    endif()
  else()
    list(APPEND reasons "npm: there is none")
  endif()
endif()

if(NOT is_done AND SOURCE MATCHES "auto|debian")
  if(ESBUILD AND THREE)
    # Laid out as npm's package is, whose names viewer.js uses.
    file(REMOVE_RECURSE ${WORK}/node_modules)
    set(package ${WORK}/node_modules/three)
    foreach(file build/three.module.js examples/jsm/controls/OrbitControls.js)
      # Debian has links among them.
      file(REAL_PATH ${THREE}/${file} real)
      configure_file(${real} ${package}/${file} COPYONLY)
    endforeach()
    file(WRITE ${package}/package.json [[{ "name": "three", "exports":
        { ".": "./build/three.module.js", "./addons/*": "./examples/jsm/*" } }]])
    bundle(Debian ${ESBUILD} viewer.js)
  else()
    list(APPEND reasons "Debian: the packages esbuild and libjs-three are not both there")
  endif()
endif()

set(literal "")
if(is_done)
  file(READ ${WORK}/bundle.js script)
  # It stands inside a <script> element.
  if(script MATCHES "</[sS][cC][rR][iI][pP][tT]")
    message(FATAL_ERROR "the bundle holds the end of a script element")
  endif()
  file(READ ${WORK}/bundle.js literal HEX)
  # Every byte is an escape, so that none can run into the next one.
  string(REGEX REPLACE "(..)" "\\\\x\\1" literal "${literal}")
elseif(SOURCE MATCHES "npm|debian")
  list(JOIN reasons "; " reasons)
  message(FATAL_ERROR "FPPG_VIEWER=${SOURCE}: ${reasons}")
elseif(SOURCE STREQUAL "auto")
  list(JOIN reasons "; " reasons)
  message(STATUS "3-D view of report pages: left out (${reasons})")
endif()
file(REMOVE_RECURSE ${WORK}/node_modules)
file(WRITE ${OUTPUT} "#include \"report/scene.h\"\n\nnamespace fppg\n{\n\nstd::string_view viewer_script()\n{\n    using namespace std::string_view_literals;\n    return \"${literal}\"sv;\n}\n\n} // namespace fppg\n")
