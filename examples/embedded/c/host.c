/* This machine instead of the board: the same program computes the same numbers, and no time passes. */
#include "board.h"
#include <stdio.h>
#include <stdlib.h>

static uint32_t milliseconds;

void board_start(void)
{
}

uint32_t board_wait(void)
{
    return ++milliseconds;
}

uint32_t board_ticks(void)
{
    return 0;
}

uint32_t board_stack_of(void (*call)(void))
{
    call();
    return 0;
}

void board_print(const char *name, uint32_t number)
{
    printf("%s %lu\n", name, (unsigned long)number);
}

void board_exit(int code)
{
    exit(code);
}
