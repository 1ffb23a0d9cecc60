# Built on demand: cmake --build --preset release --target near_elements_bench frame_bench ladder_bench planar_bench (libbenchmark-dev)
find_package(benchmark QUIET)
if(benchmark_FOUND)
  foreach(bench near_elements_bench frame_bench ladder_bench planar_bench)
    add_executable(${bench} EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/${bench}.cpp)
    target_link_libraries(${bench} PRIVATE topple_io GTest::gtest benchmark::benchmark)
    target_include_directories(${bench} PRIVATE ${CMAKE_CURRENT_LIST_DIR}/..)
  endforeach()
endif()

# Likewise; window_bench build/release/topple
add_executable(window_bench EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/window_bench.cpp)
target_link_libraries(window_bench PRIVATE topple_app PkgConfig::IMGUI GTest::gtest)
target_include_directories(window_bench PRIVATE ${CMAKE_CURRENT_LIST_DIR}/..)

include(${CMAKE_CURRENT_LIST_DIR}/engines/engines.cmake)
