/* An MPS2 board with a Cortex-M4F (QEMU's mps2-an386): start-up, a console by semihosting, a counter of instructions. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

void board_print(const char *text);
void board_print_number(double value, int decimals);
void board_exit(int code);

/* Ticks of SysTick, which counts down 24 bits. */
void board_start_ticks(void);
uint32_t board_ticks(void);
/* Under `qemu -icount shift=10` an instruction takes 1.024 us, which are 25.6 ticks of the board's 25 MHz. */
double board_instructions(uint32_t before, uint32_t after);

#endif
