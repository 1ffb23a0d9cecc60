file(GLOB_RECURSE solver_test_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*_test.cpp)
# one that counts allocations has a program of its own, and one that steps from every number spoiled
list(FILTER solver_test_sources EXCLUDE REGEX "(allocation|containment)_test")
add_executable(solver_test ${solver_test_sources})
target_link_libraries(solver_test PRIVATE topple_solver GTest::gtest_main mpfr)
target_include_directories(solver_test PRIVATE ${CMAKE_CURRENT_LIST_DIR}/../..)
target_compile_definitions(solver_test PRIVATE TOPPLE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
gtest_discover_tests(solver_test)

add_executable(allocation_test ${CMAKE_CURRENT_LIST_DIR}/step/allocation_test.cpp)
target_link_libraries(allocation_test PRIVATE topple_solver GTest::gtest_main)
target_include_directories(allocation_test PRIVATE ${CMAKE_CURRENT_LIST_DIR}/../..)
gtest_discover_tests(allocation_test)

add_executable(containment_test ${CMAKE_CURRENT_LIST_DIR}/body/containment_test.cpp)
target_include_directories(containment_test PRIVATE ${CMAKE_CURRENT_LIST_DIR}/../..)
target_link_libraries(containment_test PRIVATE topple_solver GTest::gtest_main)
gtest_discover_tests(containment_test)
