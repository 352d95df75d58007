# Frames: their numbers, their names, and what they are shown by alike.
set(tools ${PROJECT_SOURCE_DIR}/tools)
deltasplat_test(unit/frame_list_test.cpp SOURCES ${tools}/sequence/frame_list.cpp
    ${tools}/options/parse.cpp)
deltasplat_test(unit/frame_name_test.cpp SOURCES ${tools}/sequence/frame_name.cpp)
deltasplat_test(unit/sequence_look_test.cpp SOURCES ${tools}/sequence/sequence_look.cpp)
