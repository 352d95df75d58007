# Batches: which files a pattern finds, what their pictures are called, and the page of them; files
# of previews.
set(tools ${PROJECT_SOURCE_DIR}/tools)
deltasplat_test(unit/file_pattern_test.cpp SOURCES ${tools}/batch/file_pattern.cpp)
deltasplat_test(unit/memory_gate_test.cpp SOURCES ${tools}/batch/memory_gate.cpp)
deltasplat_test(unit/output_name_test.cpp SOURCES ${tools}/batch/output_name.cpp)
deltasplat_test(unit/index_page_test.cpp SOURCES ${tools}/batch/index_page.cpp
    ${tools}/page/page_parts.cpp ${tools}/page/picture_data.cpp ${tools}/text/utf8_text.cpp)
deltasplat_test(unit/preview_file_test.cpp SOURCES ${tools}/render/preview_file.cpp)
deltasplat_test(unit/thumbnail_test.cpp)
