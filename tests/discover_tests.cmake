# Writes OUTPUT, the list of tests of a Catch2 EXECUTABLE for ctest: one entry per TEST_CASE of MODULE, labelled with the
# module, its tags, and `quick` unless it is tagged [slow]; those that are have a COST, in seconds: ctest begins with the
# dearest, and keeps no times itself of tests whose names hold blanks. Catch2 2.13 lists no tags beside whole names, so
# the names are asked for tag by tag. LIST_NAMES: the options that make this Catch2 print names only; RUN_OPTIONS: those
# that each test is run with.
cmake_minimum_required(VERSION 3.25)
separate_arguments(LIST_NAMES)

# Catch2 2.13 returns the number of names listed (modulo 256) as its exit code: any number is success there.
function(ask result)
  execute_process(COMMAND ${EXECUTABLE} ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE error RESULT_VARIABLE code)
  if(NOT code MATCHES "^[0-9]+$" OR error)
    message(FATAL_ERROR "${EXECUTABLE} ${ARGN}: result ${code}\n${output}${error}")
  endif()
  set(${result} "${output}" PARENT_SCOPE)
endfunction()

# Semicolons and brackets mean something in a CMake list: control characters stand for them until the end.
string(ASCII 28 semicolon)
string(ASCII 29 open)
string(ASCII 30 close)

function(names result)
  ask(output ${ARGN} ${LIST_NAMES})
  if(output MATCHES "[\\]")
    message(FATAL_ERROR "${EXECUTABLE}: a test name holds a backslash, which Catch2 cannot select; rename it:\n${output}")
  endif()
  string(REPLACE ";" "${semicolon}" output "${output}")
  string(REPLACE "[" "${open}" output "${output}")
  string(REPLACE "]" "${close}" output "${output}")
  string(REGEX MATCHALL "[^\n]+" lines "${output}")
  set(${result} "${lines}" PARENT_SCOPE)
endfunction()

names(all)
if(NOT all)
  message(FATAL_ERROR "${EXECUTABLE} contains no tests; remove its sources or write one")
endif()
names(slow "[slow]")
ask(tag_list --list-tags)
string(REGEX MATCHALL "\\[[^]\n]+\\]" tags "x${tag_list}")
set(plain_tags)
foreach(tag IN LISTS tags)
  string(REGEX REPLACE "[][]" "" plain "${tag}")
  if(plain MATCHES "^[A-Za-z0-9]" AND NOT plain STREQUAL "quick")
    list(APPEND plain_tags "${plain}")
    names(tagged_${plain} "[${plain}]")
  endif()
endforeach()

set(script "")
foreach(test IN LISTS all)
  set(labels ${MODULE})
  foreach(tag IN LISTS plain_tags)
    if(test IN_LIST tagged_${tag})
      list(APPEND labels ${tag})
    endif()
  endforeach()
  if(test IN_LIST slow)
    set(cost 5)
  else()
    list(APPEND labels quick)
    set(cost 0)
  endif()
  list(REMOVE_DUPLICATES labels)
  # Commas and brackets mean something in a Catch2 test specification.
  string(REGEX REPLACE "([,${open}])" "\\\\\\1" pattern "${test}")
  string(APPEND script "add_test([==[${MODULE}: ${test}]==] [==[${EXECUTABLE}]==] [==[${pattern}]==] ${RUN_OPTIONS})\n"
                       "set_tests_properties([==[${MODULE}: ${test}]==] PROPERTIES LABELS [==[${labels}]==] COST ${cost})\n")
endforeach()
string(REPLACE "${semicolon}" ";" script "${script}")
string(REPLACE "${open}" "[" script "${script}")
string(REPLACE "${close}" "]" script "${script}")
file(WRITE "${OUTPUT}" "${script}")
