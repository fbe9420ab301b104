/* SPDX-License-Identifier: Apache-2.0 */
/* A model.json and inputs, in: predictions out. */
#include <kelpie/kelpie.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_BYTES = 1 << 26 };

int main(int argc, char** argv) {
  char* const text = malloc(MOST_BYTES);
  FILE* const file = argc > 1 ? fopen(argv[1], "rb") : NULL;
  kelpie_trained* model = NULL;
  double x[KELPIE_MOST_INPUTS];
  kelpie_prediction y[KELPIE_MOST_TARGETS];
  size_t targets;
  size_t i;
  if (text == NULL || file == NULL) {
    return 1;
  }
  if (kelpie_read_trained(text, fread(text, 1, MOST_BYTES, file), &model) != KELPIE_OK) {
    fprintf(stderr, "%s\n", kelpie_last_error());
    return 2;
  }
  fclose(file);
  for (i = 0; i + 2 < (size_t)argc && i < KELPIE_MOST_INPUTS; ++i) {
    x[i] = strtod(argv[i + 2], NULL);
  }
  targets = kelpie_trained_target_count(model);
  if (kelpie_trained_assess(model, x, i, y, targets) != KELPIE_OK) {
    fprintf(stderr, "%s\n", kelpie_last_error());
    return 2;
  }
  for (i = 0; i < targets; ++i) {
    printf("%s %.17g\n", kelpie_trained_target_name(model, i), y[i].value);
  }
  kelpie_free_trained(model);
  free(text);
  return 0;
}
