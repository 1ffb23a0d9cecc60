# Where emscripten and node are installed.
find_program(NODE node)
if(TARGET page_engine AND NODE)
  add_test(NAME live_page COMMAND ${CMAKE_CURRENT_LIST_DIR}/run $<TARGET_FILE:topple>
    ${TOPPLE_PAGE_BUILD}/app/page/web/page_engine.js ${CMAKE_CURRENT_BINARY_DIR}/page)
  set_tests_properties(live_page PROPERTIES TIMEOUT 1500 COST 1000)  # begins first: it takes longest
endif()
