# Built on demand: cmake --build --preset release --target engines_bench
# (any of libmujoco-dev, libbullet-dev, libode-dev)
find_package(fmt REQUIRED)
add_executable(engines_bench EXCLUDE_FROM_ALL
  ${CMAKE_CURRENT_LIST_DIR}/block.cpp
  ${CMAKE_CURRENT_LIST_DIR}/chart.cpp
  ${CMAKE_CURRENT_LIST_DIR}/edges.cpp
  ${CMAKE_CURRENT_LIST_DIR}/main.cpp
  ${CMAKE_CURRENT_LIST_DIR}/results.cpp
  ${CMAKE_CURRENT_LIST_DIR}/room_scenes.cpp
  ${CMAKE_CURRENT_LIST_DIR}/rooms.cpp
  ${CMAKE_CURRENT_LIST_DIR}/topple.cpp
  ${CMAKE_CURRENT_LIST_DIR}/topple_rooms.cpp
  ${CMAKE_CURRENT_LIST_DIR}/tosses.cpp
  ${CMAKE_CURRENT_LIST_DIR}/trial.cpp)
# Engines have Options and World each
set_target_properties(engines_bench PROPERTIES UNITY_BUILD OFF)
target_link_libraries(engines_bench PRIVATE topple_study fmt::fmt)
target_compile_definitions(engines_bench PRIVATE TOPPLE_VERSION="${PROJECT_VERSION}")
target_include_directories(engines_bench PRIVATE ${CMAKE_CURRENT_LIST_DIR}/../..)

# Debian's mujocoConfig.cmake names a folder that is not there
find_path(MUJOCO_INCLUDE_DIR mujoco/mujoco.h)
find_library(MUJOCO_LIBRARY mujoco)
if(MUJOCO_INCLUDE_DIR AND MUJOCO_LIBRARY)
  target_sources(engines_bench PRIVATE ${CMAKE_CURRENT_LIST_DIR}/mujoco.cpp
    ${CMAKE_CURRENT_LIST_DIR}/mujoco_model.cpp ${CMAKE_CURRENT_LIST_DIR}/mujoco_rooms.cpp
    ${CMAKE_CURRENT_LIST_DIR}/mujoco_tosses.cpp)
  target_include_directories(engines_bench SYSTEM PRIVATE ${MUJOCO_INCLUDE_DIR})
  target_link_libraries(engines_bench PRIVATE ${MUJOCO_LIBRARY})
  target_compile_definitions(engines_bench PRIVATE WITH_MUJOCO)
endif()
pkg_check_modules(BULLET QUIET IMPORTED_TARGET bullet-float64)
if(BULLET_FOUND)
  target_sources(engines_bench PRIVATE ${CMAKE_CURRENT_LIST_DIR}/bullet.cpp ${CMAKE_CURRENT_LIST_DIR}/bullet_tosses.cpp)
  target_link_libraries(engines_bench PRIVATE PkgConfig::BULLET)
  target_compile_definitions(engines_bench PRIVATE WITH_BULLET)
endif()
pkg_check_modules(ODE QUIET IMPORTED_TARGET ode)
if(ODE_FOUND)
  target_sources(engines_bench PRIVATE ${CMAKE_CURRENT_LIST_DIR}/ode.cpp)
  target_link_libraries(engines_bench PRIVATE PkgConfig::ODE)
  target_compile_definitions(engines_bench PRIVATE WITH_ODE)
endif()
