/*
 * What both fuzzers share.  A message of a bug in tremie is a finding: CHECK() aborts here,
 * which the fuzzer notes (the linker puts __wrap_report_bug in its place, and so for memory and
 * checksums).
 */
#ifndef TREMIE_TESTS_FUZZ_H
#define TREMIE_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

/* libFuzzer's. */
int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Replaces a file of this process in the present folder by these bytes; its path. */
const char *fuzz_file(const void *bytes, size_t n);

#endif
