# Writes each block of C++ of a page into a file of its own, 1.cpp and so on in `folder`. One that
# has no main() becomes a function, and the fourth stands within the loop that ends the third.
/^```cpp$/ { inside = 1; ++count; next }
/^```$/ && inside {
    inside = 0
    file = folder "/" count ".cpp"
    if (count == 4) {
        headers[4] = headers[3] headers[4]
        body[4] = substr(body[3], 1, length(body[3]) - 2) body[4] "}\n"
    }
    if (body[count] ~ /int main/)
        printf "%s%s", headers[count], body[count] > file
    else
        printf "%svoid snippet%d() {\n%s}\n", headers[count], count, body[count] > file
    close(file)
}
inside && /^#include/ { headers[count] = headers[count] $0 "\n"; next }
inside { body[count] = body[count] $0 "\n" }
