# Pictures of numbers, which the program draws.
set(tools ${PROJECT_SOURCE_DIR}/tools)
deltasplat_test(unit/drawing_test.cpp SOURCES ${tools}/drawing_raster.cpp ${tools}/drawing_svg.cpp
    ${tools}/plot_file.cpp ${tools}/stroke_font.cpp ${tools}/utf8_text.cpp)
deltasplat_test(unit/slice_plot_test.cpp SOURCES ${tools}/drawing_svg.cpp ${tools}/slice_plot.cpp
    ${tools}/stroke_font.cpp ${tools}/utf8_text.cpp)
