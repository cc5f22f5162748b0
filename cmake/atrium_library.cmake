# atrium_add_library(name [ROOT dir] SOURCES ... [PUBLIC targets...] [PRIVATE targets...])
#
# One library of the project: alias atrium::name, C++20, the warnings, the public include root
# (and only that) for its users, precompiled standard headers, export set.
set(ATRIUM_WARNINGS -Wall -Wextra -Wconversion -Wshadow
    $<$<CXX_COMPILER_ID:GNU>:-Wdouble-promotion>)  # clang means arguments of functions, too
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  list(APPEND ATRIUM_WARNINGS -Wno-restrict)  # false alarms for "text" + std::string (GCC PR105651)
  # ... and, at -O1, for variants that hold vectors
  list(APPEND ATRIUM_WARNINGS $<$<CONFIG:RelWithDebInfo>:-Wno-array-bounds>)
endif()

function(atrium_compile_settings target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE ${ATRIUM_WARNINGS}
                         $<$<BOOL:${ATRIUM_WARNINGS_AS_ERRORS}>:-Werror>
                         # Lets ccache see through precompiled headers; without it nothing is cached.
                         $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endfunction()

function(atrium_add_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;PUBLIC;PRIVATE")
  add_library(atrium_${name} STATIC ${arg_SOURCES})
  add_library(atrium::${name} ALIAS atrium_${name})
  atrium_compile_settings(atrium_${name})
  set_target_properties(atrium_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(atrium_${name}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
           $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/atrium>
    PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_link_libraries(atrium_${name} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  set_property(GLOBAL APPEND PROPERTY ATRIUM_LIBRARIES atrium_${name})
  set_property(GLOBAL APPEND PROPERTY ATRIUM_INCLUDE_DIRS ${CMAKE_CURRENT_SOURCE_DIR}/include)
endfunction()

# atrium_precompile(target headers...): the same headers for every source of a target.
function(atrium_precompile target)
  target_precompile_headers(${target} PRIVATE ${ARGN})
endfunction()
