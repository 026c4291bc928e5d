# cmake -D BUILD=… -D CONSUMER=… -D WORK=… -D CXX=… [-D LAUNCHER=…] -P check.cmake
# Installs Carom, and gates the consumer's engines as its author would: configure, build, ctest.
cmake_minimum_required(VERSION 3.25)

# run(<expected exit code> <what> <command>…), with the output in `output`
function(run expected what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT code EQUAL expected)
    message(FATAL_ERROR "${what}: ended with ${code}, not ${expected}\n${out}${err}")
  endif()
  set(output "${out}${err}" PARENT_SCOPE)
endfunction()

function(expect text)
  string(FIND "${output}" "${text}" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "\"${text}\" was not said:\n${output}")
  endif()
endfunction()

function(expect_file file text)
  file(READ "${file}" output)
  expect("${text}")
endfunction()

set(ctest ${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/build --output-on-failure)

file(REMOVE_RECURSE ${WORK})
run(0 "install" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
# The lab of the installed program serves the installed page. Without node and npm there is none to install.
if(EXISTS ${BUILD}/lib/carom/web/lab.html)
  run(0 "the lab" sh -c "${WORK}/prefix/bin/carom lab --port 0 >${WORK}/lab.txt 2>&1 & echo $!")
  string(STRIP "${output}" lab)
  set(address "")
  foreach(tenth RANGE 300)
    file(READ ${WORK}/lab.txt said)
    if(said MATCHES "http://[0-9.:]+/")
      set(address ${CMAKE_MATCH_0})
      break()
    endif()
    execute_process(COMMAND ${CMAKE_COMMAND} -E sleep 0.1)
  endforeach()
  file(DOWNLOAD ${address} ${WORK}/lab.html TIMEOUT 30)
  file(DOWNLOAD ${address}lab.js ${WORK}/lab.js TIMEOUT 30)
  file(DOWNLOAD ${address}api/modes ${WORK}/modes.json TIMEOUT 30)
  execute_process(COMMAND kill ${lab})
  expect_file(${WORK}/lab.html "<script src=\"lab.js\">")
  expect_file(${WORK}/lab.js "caromLab")
  expect_file(${WORK}/modes.json "course/quantum-barrier")
endif()

run(0 "configure" ${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/build -G Ninja
  -D CMAKE_PREFIX_PATH=${WORK}/prefix -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})
run(0 "build" ${CMAKE_COMMAND} --build ${WORK}/build)

run(0 "the gate of the right engine" ${ctest} --tests-regex physics)
expect("100% tests passed")
expect_file(${WORK}/build/physics.xml "<testcase classname=\"impact/head-on.mine\" name=\"energy\"")
expect_file(${WORK}/build/physics.md "Every gate holds")

run(8 "the gate of the broken engine" ${ctest} --tests-regex careless)
expect("violated: impact/head-on: careless: momentum = ")
expect_file(${WORK}/build/careless.xml "<failure message=\"impact/head-on: careless: momentum = ")

# Without its file the baseline is an error; the target of the same name writes it.
run(8 "a gate without its baseline" ${ctest} --tests-regex against-baseline)
expect("baseline.json: cannot be read")
run(0 "the baseline" ${CMAKE_COMMAND} --build ${WORK}/build --target against-baseline-baseline)
run(0 "the gate with its baseline" ${ctest} --tests-regex against-baseline)
file(REMOVE_RECURSE ${WORK})
