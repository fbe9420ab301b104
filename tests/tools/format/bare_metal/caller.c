/* SPDX-License-Identifier: Apache-2.0
 * Calls an exported model on a Cortex-M4 without an operating system, and prints what it says, by
 * semihosting: a line of y, half width and novelty per target and input, all as the bits of floats;
 * then the bytes of stack that a call took. `inputs.h` has the inputs. */
#include <stdint.h>

#include "model.h"
/* */
#include "inputs.h"

enum { STACK_LOOKED_AT = 8192 };

extern char stack_end;
void start(void);
__attribute__((section(".vectors"), used)) static const void *const vectors[2] = {&stack_end,
                                                                                 (void *)start};

static int semihosting(int operation, const void *argument)
{
  register int r0 __asm__("r0") = operation;
  register const void *r1 __asm__("r1") = argument;
  __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

static void print(uint32_t bits, char end)
{
  char text[10];
  int i;
  for (i = 0; i < 8; ++i) {
    text[i] = "0123456789abcdef"[bits >> (28 - 4 * i) & 15];
  }
  text[8] = end;
  text[9] = 0;
  semihosting(4, text); /* SYS_WRITE0 */
}

static void print_float(float value, char end)
{
  union {
    float value;
    uint32_t bits;
  } both;
  both.value = value;
  print(both.bits, end);
}

/* Below what main() has of the stack a pattern is laid, and what is left of it looked for. */
__attribute__((noinline)) static uint32_t stack_of_a_call(void)
{
  static float y[kelpie_model_targets], slopes[kelpie_model_targets * kelpie_model_inputs];
  volatile uint8_t *const top = __builtin_frame_address(0);
  volatile uint8_t *const bottom = top - STACK_LOOKED_AT;
  volatile uint8_t *at;
  for (at = bottom; at < top - 64; ++at) {
    *at = 0xa5;
  }
  kelpie_model_predict_with_jacobian(inputs[0], y, slopes);
  for (at = bottom; *at == 0xa5; ++at) {
  }
  return (uint32_t)(top - at);
}

int main(void)
{
  unsigned i, k;
  for (i = 0; i < sizeof inputs / sizeof inputs[0]; ++i) {
    float y[kelpie_model_targets], half_width[kelpie_model_targets], novelty[kelpie_model_targets];
    kelpie_model_assess(inputs[i], y, half_width, novelty);
    for (k = 0; k < kelpie_model_targets; ++k) {
      print_float(y[k], ' ');
      print_float(half_width[k], ' ');
      print_float(novelty[k], '\n');
    }
  }
  print(stack_of_a_call(), '\n');
  return 0;
}

void start(void)
{
  *(volatile uint32_t *)0xe000ed88 |= 0xfu << 20; /* CPACR: the floating-point unit is on */
  __asm__ volatile("dsb\nisb");
  main();
  semihosting(0x18, (const void *)0x20026); /* SYS_EXIT, ADP_Stopped_ApplicationExit */
  for (;;) {
  }
}
