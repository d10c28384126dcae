/* What the test driver needs from its surroundings: files, an exit, and the stack pointer. */
#ifndef BOARD_H
#define BOARD_H

#include <stddef.h>
#include <stdint.h>

enum { BOARD_READ = 1, BOARD_WRITE = 5 }; /* modes rb and wb of semihosting */

extern const uint32_t board_watched; /* bytes of stack that are painted before every call */

int board_open(const char *name, int mode);
void board_read(int file, void *bytes, size_t count);
void board_write(int file, const void *bytes, size_t count);
void board_close(int file);
void board_exit(int code);
uintptr_t board_stack_pointer(void);

#endif
