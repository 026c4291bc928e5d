# cmake -D WEB=… -D MODULES=… -D OUT=… -D NPM=… -D ENTRIES=… -P bundle.cmake
# Bundles ENTRIES of the folder WEB into OUT. npm's modules are fetched into MODULES where they are not those of the
# lock file; one build at a time, as presets share them.
file(MAKE_DIRECTORY ${MODULES})
file(LOCK ${MODULES}/lock GUARD PROCESS TIMEOUT 600)

set(wanted "")
foreach(name package.json package-lock.json .npmrc)
  file(SHA256 ${WEB}/${name} hash)
  string(APPEND wanted "${hash}\n")
endforeach()
set(there "")
if(EXISTS ${MODULES}/fetched)
  file(READ ${MODULES}/fetched there)
endif()
if(NOT there STREQUAL wanted)
  foreach(name package.json package-lock.json .npmrc)
    file(COPY ${WEB}/${name} DESTINATION ${MODULES})
  endforeach()
  execute_process(COMMAND ${NPM} ci --ignore-scripts --loglevel=error WORKING_DIRECTORY ${MODULES}
    RESULT_VARIABLE status OUTPUT_VARIABLE log ERROR_VARIABLE log)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "npm ci failed in ${MODULES} (without the viewer: cmake -D CAROM_VIEWER=OFF):\n${log}")
  endif()
  file(WRITE ${MODULES}/fetched "${wanted}")
endif()

string(REPLACE "," ";" ENTRIES ${ENTRIES})
list(TRANSFORM ENTRIES PREPEND ${WEB}/)
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=${MODULES}/node_modules ${MODULES}/node_modules/.bin/esbuild ${ENTRIES}
    --bundle --minify --format=iife --target=es2022 --charset=utf8 --entry-names=[name] --log-level=warning
    --outdir=${OUT}
  RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "esbuild failed")
endif()
