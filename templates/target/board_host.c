/* The board on the machine that builds: plain files. */
#include <stdio.h>
#include <stdlib.h>

#include "board.h"

const uint32_t board_watched = WATCHED;

#define MOST_FILES 8

static FILE *files[MOST_FILES];

int board_open(const char *name, int mode) {
    for (int k = 0; k < MOST_FILES; k++) {
        if (files[k] == NULL) {
            files[k] = fopen(name, mode == BOARD_READ ? "rb" : "wb");
            if (files[k] == NULL) {
                board_exit(2);
            }
            return k;
        }
    }
    board_exit(2);
    return -1;
}

void board_read(int file, void *bytes, size_t count) {
    if (fread(bytes, 1, count, files[file]) != count) {
        board_exit(2);
    }
}

void board_write(int file, const void *bytes, size_t count) {
    if (fwrite(bytes, 1, count, files[file]) != count) {
        board_exit(2);
    }
}

void board_close(int file) {
    fclose(files[file]);
    files[file] = NULL;
}

void board_exit(int code) {
    exit(code);
}

uintptr_t board_stack_pointer(void) {
    return 0; /* stacks are measured on targets only */
}
