/* Runs a fuzz target once on each file that is named, without libFuzzer: regress/checks/fuzz.sh. */
#include "fuzz.h"

int main(int count, char **words)
{
    enum { MOST = 1 << 20 };
    uint8_t *bytes = malloc(MOST);
    if (bytes == NULL) return 1;
    for (int i = 1; i < count; i++) {
        FILE *file = fopen(words[i], "rb");
        if (file == NULL) return 1;
        const size_t length = fread(bytes, 1, MOST, file);
        fclose(file);
        fprintf(stderr, "%s\n", words[i]);
        LLVMFuzzerTestOneInput(bytes, length);
    }
    free(bytes);
    return 0;
}
