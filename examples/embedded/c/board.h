/*
 * What the program needs of a board: a millisecond, a clock, a measure of the stack, and a way to print. `cortex_m.c` has it
 * for a Cortex-M under QEMU, `host.c` for this machine, where time stands still.
 */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

/* Starts the timer whose interrupt comes every millisecond. */
void board_start(void);
/* Sleeps until the next millisecond begins, and returns the number of milliseconds since the start. */
uint32_t board_wait(void);
/* The time within the millisecond, in ticks of 40 ns. */
uint32_t board_ticks(void);
/* The bytes of stack that a call takes. */
uint32_t board_stack_of(void (*call)(void));
/* Prints a line: a name and a number. */
void board_print(const char *name, uint32_t number);
/* Ends the program; 0 is a success. */
void board_exit(int code);

#endif
