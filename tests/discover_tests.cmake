# Writes OUTPUT, the list of tests of a Catch2 EXECUTABLE for ctest: one entry per TEST_CASE of ROOM, labelled with the
# room, its tags, and `quick` unless it is tagged [slow]. Catch2 2.13 lists no tags beside whole names, so the names
# are asked for tag by tag. LIST_NAMES: the options that make this Catch2 print names only; RUN_OPTIONS: those that each
# test is run with.
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

function(names result)
  ask(output ${ARGN} ${LIST_NAMES})
  if(output MATCHES "[][;\\]")
    message(FATAL_ERROR "${EXECUTABLE}: a test name holds one of [ ] ; \\, which ctest cannot carry; rename it:\n${output}")
  endif()
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
  set(labels ${ROOM})
  foreach(tag IN LISTS plain_tags)
    if(test IN_LIST tagged_${tag})
      list(APPEND labels ${tag})
    endif()
  endforeach()
  if(NOT test IN_LIST slow)
    list(APPEND labels quick)
  endif()
  list(REMOVE_DUPLICATES labels)
  # A comma separates patterns in a Catch2 test specification.
  string(REPLACE "," "\\," pattern "${test}")
  string(APPEND script "add_test([==[${ROOM}: ${test}]==] [==[${EXECUTABLE}]==] [==[${pattern}]==] ${RUN_OPTIONS})\n"
                       "set_tests_properties([==[${ROOM}: ${test}]==] PROPERTIES LABELS [==[${labels}]==])\n")
endforeach()
file(WRITE "${OUTPUT}" "${script}")
