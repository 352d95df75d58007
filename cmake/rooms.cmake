# The rooms of src/, bottom to top, as targets deltasplat_NAME.
set(DELTASPLAT_ROOMS)

# Declares the room src/NAME. Its files see its own headers, those of the rooms that it uses, and
# nothing else of src/: each room has an include path of its own, on which its folder lies as NAME/.
#   USES     rooms below it
#   PUBLIC   headers of include/deltasplat/ that belong to it
#   LIBRARIES  of others, besides those that all rooms have
#   SOURCES  its .cpp files; a room of headers has none
#   LOOPS    it has loops over voxels or pixels outside of its kernels
function(deltasplat_room name)
    cmake_parse_arguments(PARSE_ARGV 1 room "LOOPS" "" "USES;PUBLIC;LIBRARIES;SOURCES")
    set(path ${CMAKE_BINARY_DIR}/deltasplat_rooms/${name})
    file(MAKE_DIRECTORY ${path})
    file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/src/${name} ${path}/${name} SYMBOLIC)
    foreach(header ${room_PUBLIC})
        get_filename_component(folder ${path}/deltasplat/${header} DIRECTORY)
        file(MAKE_DIRECTORY ${folder})
        file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/include/deltasplat/${header}
            ${path}/deltasplat/${header} SYMBOLIC)
    endforeach()
    list(TRANSFORM room_SOURCES PREPEND src/${name}/)
    list(TRANSFORM room_USES PREPEND deltasplat_)
    set(target deltasplat_${name})
    if(NOT room_SOURCES)
        add_library(${target} INTERFACE)
        target_include_directories(${target} INTERFACE ${path})
        target_link_libraries(${target} INTERFACE ${room_USES})
        return()
    endif()
    add_library(${target} OBJECT ${room_SOURCES})
    target_include_directories(${target} PUBLIC ${path})
    target_compile_features(${target} PUBLIC cxx_std_20)
    target_compile_definitions(${target} PRIVATE DELTASPLAT_VERSION="${PROJECT_VERSION}")
    target_link_libraries(${target} PUBLIC ${room_USES} glm::glm
        PRIVATE ${room_LIBRARIES} TBB::tbb hwy::hwy ZLIB::ZLIB nlohmann_json::nlohmann_json)
    deltasplat_compile_options(${target})
    if(NOT room_LOOPS)
        deltasplat_quick_to_compile(${target})
    endif()
    list(APPEND DELTASPLAT_ROOMS ${target})
    set(DELTASPLAT_ROOMS ${DELTASPLAT_ROOMS} PARENT_SCOPE)
endfunction()
