# Fails, naming them, if the kernel OBJECTS define weak (W, V) or unique (u) symbols, as NM shows them.
cmake_minimum_required(VERSION 3.25)
foreach(object IN LISTS OBJECTS)
  execute_process(COMMAND ${NM} --defined-only --demangle ${object} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[0-9a-f]+ [WVu] [^\n]+" weak "${symbols}")
  if(weak)
    list(JOIN weak "\n  " weak)
    message(SEND_ERROR "${object} defines weak symbols; keep templates of the standard library and Eigen out of the "
                       "kernel files, or make the function static:\n  ${weak}")
  endif()
endforeach()
