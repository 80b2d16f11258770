/* A Cortex-M with a floating-point unit, without an operating system and without a C library, under QEMU. */
#include "board.h"

#define SYSTICK ((volatile uint32_t *)0xe000e010) /* control, reload value, current value */
/* A tick of 25 MHz is 40 ns. */
#define TICKS_PER_MS 25000U
/* More than any call here takes, in words. */
#define PAINTED 2048
#define PAINT 0xfeedbeefU

int main(void);
void reset(void);
void millisecond(void);

extern uint32_t stack_top[];
static volatile uint32_t milliseconds;

/* The processor begins with the stack pointer and the address that lie at address 0. Entry 15 is the timer's. */
static const union {
    const uint32_t *stack;
    void (*handler)(void);
} vectors[16] __attribute__((section(".vectors"), used)) = {
    [0] = {.stack = stack_top}, [1] = {.handler = reset}, [15] = {.handler = millisecond}};

/* The floating-point unit is enabled before anything uses it; memory that is not in the file is zero under QEMU. */
__attribute__((naked)) void reset(void)
{
    __asm volatile("ldr r0, =0xe000ed88\n ldr r1, [r0]\n orr r1, r1, #(0xf << 20)\n str r1, [r0]\n dsb\n isb\n bl main\n");
}

void millisecond(void)
{
    milliseconds = milliseconds + 1;
}

void board_start(void)
{
    SYSTICK[1] = TICKS_PER_MS - 1;
    SYSTICK[2] = 0;
    SYSTICK[0] = 7;
}

uint32_t board_wait(void)
{
    const uint32_t before = milliseconds;
    while (milliseconds == before) {
        __asm volatile("wfi");
    }
    return milliseconds;
}

uint32_t board_ticks(void)
{
    return TICKS_PER_MS - 1 - SYSTICK[2];
}

/* Paints what lies below the stack, and looks how much of the paint is left. An interrupt would be seen, too. */
__attribute__((noinline)) uint32_t board_stack_of(void (*call)(void))
{
    volatile uint32_t *top;
    uint32_t left = 0;
    __asm volatile("cpsid i\n mov %0, sp" : "=r"(top));
    for (int i = 1; i <= PAINTED; i++) {
        top[-i] = PAINT;
    }
    call();
    while (left < PAINTED && top[(int)left - PAINTED] == PAINT) {
        left++;
    }
    __asm volatile("cpsie i");
    return 4 * (PAINTED - left);
}

/* Asks QEMU for a service. */
static void semihosting(uint32_t operation, uint32_t argument)
{
    register uint32_t r0 __asm("r0") = operation;
    register uint32_t r1 __asm("r1") = argument;
    __asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void print(const char *text)
{
    semihosting(0x04, (uint32_t)text);
}

void board_print(const char *name, uint32_t number)
{
    char digits[12], *first = digits + sizeof digits;
    *--first = '\0';
    *--first = '\n';
    do {
        *--first = (char)('0' + number % 10);
        number /= 10;
    } while (number > 0);
    print(name);
    print(" ");
    print(first);
}

void board_exit(int code)
{
    semihosting(0x18, code == 0 ? 0x20026 : 0x20023);
    for (;;) {
    }
}
