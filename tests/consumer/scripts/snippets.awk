# Writes each program among the blocks of C++ of a page into a file of its own, 1.cpp and so on in
# `folder`.
/^```cpp$/ { inside = 1; ++count; next }
/^```$/ && inside { inside = 0; next }
inside { print > (folder "/" count ".cpp") }
