# The laboratory as WebAssembly (preset wasm): packing, tests, measures and what is calibrated from them, without HDF5,
# threads and the C interface.
set(web ${PROJECT_SOURCE_DIR}/tools/web/native)
room_sources(laboratory_sources pack protocol calibrate ensemble)
# What a page loads at first is as small as it may be: kernels of what it can ask for, and small code where no loop is
# (-Os for the core, which then calls each accessor of Eigen, would save a seventh and take 1.6 times as long or more).
target_compile_definitions(rvelab_core PRIVATE RVELAB_FEWER_KERNELS)
target_compile_definitions(rvelab_kernel_baseline PRIVATE RVELAB_FEWER_KERNELS)
target_compile_options(rvelab_tables PRIVATE -Os)
target_compile_options(rvelab_keys PRIVATE -Os)
add_library(rvelab_laboratory STATIC ${laboratory_sources})
target_link_libraries(rvelab_laboratory PUBLIC rvelab_keys)
target_compile_options(rvelab_laboratory PRIVATE -Os)

# Which bits a test ends with, for node (tools/web/check-bits).
add_executable(rvelab-end-state ${web}/end_state.cpp)
target_link_libraries(rvelab-end-state PRIVATE rvelab_laboratory)
target_link_options(rvelab-end-state PRIVATE -sNODERAWFS=1 -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=64MB -sEXIT_RUNTIME=1)

# The laboratory of the page. tools/web/build packs its WebAssembly into the page, compressed, so that a page opened from
# a file finds it; optimised for size at linking, since all of it is loaded at first.
add_executable(laboratory ${web}/laboratory.cpp)
target_link_libraries(laboratory PRIVATE rvelab_laboratory)
target_link_options(laboratory PRIVATE -Os --bind -sFILESYSTEM=0 -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=64MB -sMODULARIZE=1
                    -sEXPORT_ES6=1 -sUSE_ES6_IMPORT_META=0 -sENVIRONMENT=web,worker)
