# Harnesses of hostile input. Built by clang with TOPPLE_FUZZ they search by themselves (libFuzzer); else they
# go through the corpora. The preset `fuzz` leaves pointer-overflow out: Eigen adds to the null pointer of what is empty.
foreach(what scene override accelerogram recording)
  set(harness ${what}_fuzz)
  add_executable(${harness} ${CMAKE_CURRENT_LIST_DIR}/${what}_fuzz.cpp)
  target_include_directories(${harness} PRIVATE ${CMAKE_CURRENT_LIST_DIR})
  target_link_libraries(${harness} PRIVATE topple_io)
  if(TOPPLE_FUZZ)
    target_link_options(${harness} PRIVATE -fsanitize=fuzzer)
  else()
    target_sources(${harness} PRIVATE ${CMAKE_CURRENT_LIST_DIR}/replay.cpp)
    add_test(NAME ${harness} COMMAND ${harness} ${CMAKE_CURRENT_LIST_DIR}/corpus/${what})
  endif()
endforeach()
