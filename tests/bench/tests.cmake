# Built on demand: cmake --build --preset release --target near_elements_bench (libbenchmark-dev)
find_package(benchmark QUIET)
if(benchmark_FOUND)
  add_executable(near_elements_bench EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/near_elements_bench.cpp)
  target_link_libraries(near_elements_bench PRIVATE topple_solver GTest::gtest benchmark::benchmark)
  target_include_directories(near_elements_bench PRIVATE ${CMAKE_CURRENT_LIST_DIR}/..)
endif()

include(${CMAKE_CURRENT_LIST_DIR}/engines/engines.cmake)
