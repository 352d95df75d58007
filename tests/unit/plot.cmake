# Pictures of numbers, which the program draws.
set(tools ${PROJECT_SOURCE_DIR}/tools)
deltasplat_test(unit/drawing_test.cpp SOURCES ${tools}/drawing/drawing_raster.cpp
    ${tools}/drawing/drawing_svg.cpp ${tools}/drawing/plot_file.cpp ${tools}/drawing/stroke_font.cpp
    ${tools}/text/utf8_text.cpp)
deltasplat_test(unit/slice_plot_test.cpp SOURCES ${tools}/drawing/drawing_svg.cpp
    ${tools}/info/slice_plot.cpp ${tools}/drawing/stroke_font.cpp ${tools}/text/utf8_text.cpp)
