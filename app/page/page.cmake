# The template of live pages: what a browser needs, compiled by emscripten to WebAssembly and put together with
# the page's own HTML, style and script in one text, which is embedded into the program.
set(page_folder ${CMAKE_CURRENT_SOURCE_DIR}/page)
set(TOPPLE_PAGE_BUILD ${PROJECT_BINARY_DIR}/page CACHE PATH
  "Where the engine of live pages is built; builds of any kind can share it")
set(page_build ${TOPPLE_PAGE_BUILD})
set(page_html ${CMAKE_CURRENT_BINARY_DIR}/page.html)
option(TOPPLE_PAGE "Live pages (topple export --page), where emscripten is found" ON)
find_program(TOPPLE_EMCC emcc)
find_file(TOPPLE_EMSCRIPTEN_TOOLCHAIN Emscripten.cmake
  PATHS /usr/share/emscripten/cmake/Modules/Platform NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH)
set(page_files "")
if(TOPPLE_PAGE AND TOPPLE_EMCC AND TOPPLE_EMSCRIPTEN_TOOLCHAIN)
  include(ExternalProject)
  # Debian's scripts of emscripten look for their modules where NODE_PATH says
  ExternalProject_Add(page_engine
    SOURCE_DIR ${PROJECT_SOURCE_DIR}
    BINARY_DIR ${page_build}
    CONFIGURE_COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs ${CMAKE_COMMAND} -G Ninja
      -S ${PROJECT_SOURCE_DIR} -B ${page_build} -DCMAKE_TOOLCHAIN_FILE=${TOPPLE_EMSCRIPTEN_TOOLCHAIN}
      -DTOPPLE_SOLVER_ONLY=ON -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG"
      -DCMAKE_UNITY_BUILD=ON -DEigen3_DIR=${Eigen3_DIR}
    BUILD_COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs ${CMAKE_COMMAND} --build ${page_build}
      --target page_engine
    BUILD_ALWAYS ON
    USES_TERMINAL_BUILD ON
    INSTALL_COMMAND ""
    BUILD_BYPRODUCTS ${page_build}/app/page/web/page_engine.js ${page_build}/app/page/web/page_engine.wasm)
  add_custom_command(
    OUTPUT ${page_html}
    COMMAND ${CMAKE_COMMAND} -DPAGE=${page_folder}/web -DENGINE=${page_build}/app/page/web/page_engine
            -DOUTPUT=${page_html} -P ${page_folder}/assemble.cmake
    DEPENDS page_engine ${page_build}/app/page/web/page_engine.wasm ${page_folder}/web/page.html
            ${page_folder}/web/page.css ${page_folder}/web/engine_calls.js ${page_folder}/web/charts.js
            ${page_folder}/web/page.js ${page_folder}/assemble.cmake
    VERBATIM)
  set(page_files ${page_html})
elseif(TOPPLE_PAGE)
  message(STATUS "Live pages are left out: emscripten is not found (Debian package emscripten)")
endif()
topple_embed(TEMPLATE ${page_folder}/page_template.cpp.in
  OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/page_template.cpp FILES ${page_files})
