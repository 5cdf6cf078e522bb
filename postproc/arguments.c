/* See arguments.h. */
#include "arguments.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/report.h"

static void print_entry(const struct arguments_entry *entry)
{
    char left[64];
    const char *argument = entry->argument != NULL ? entry->argument : "";
    const int n =
        entry->letter != 0
            ? snprintf(left, sizeof left, "-%c, --%s %s", entry->letter, entry->name, argument)
            : snprintf(left, sizeof left, "--%s %s", entry->name, argument);
    CHECK(n > 0 && (size_t)n < sizeof left, "the option %s has too long a name", entry->name);
    printf("  %-26s %s", left, entry->help);
    for (int i = 0; entry->kind == ARGUMENTS_CHOICE && entry->choices[i] != NULL; i++)
        printf("%s%s", i == 0 ? ": " : ", ", entry->choices[i]);
    printf("\n");
}

static void print_help(const struct arguments_page *page)
{
    printf("usage: %s %s\n\n%s\n", page->tool, page->usage, page->about);
    printf("options\n");
    for (int i = 0; i < page->n_entries; i++)
        print_entry(&page->entries[i]);
    printf("  %-26s %s\n", "--help", "prints this page");
}

static const struct arguments_entry *find_entry(const struct arguments_page *page,
                                                const char *name, size_t length, char letter)
{
    for (int i = 0; i < page->n_entries; i++) {
        const struct arguments_entry *entry = &page->entries[i];
        if (letter != 0
                ? entry->letter == letter
                : strlen(entry->name) == length && strncmp(entry->name, name, length) == 0)
            return entry;
    }
    return NULL;
}

static bool take_number(const struct arguments_entry *entry, const char *text)
{
    char *end;
    const double number = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(number)) {
        report_error("--%s is given \"%s\"; give a number", entry->name, text);
        return false;
    }
    *(double *)entry->value = number;
    return true;
}

static bool take_choice(const struct arguments_entry *entry, const char *text)
{
    char list[256] = "";
    for (int i = 0; entry->choices[i] != NULL; i++) {
        if (strcmp(entry->choices[i], text) == 0) {
            *(int *)entry->value = i;
            return true;
        }
        const size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i == 0 ? "" : ", ",
                 entry->choices[i]);
    }
    report_error("--%s is given \"%s\"; choose one of %s", entry->name, text, list);
    return false;
}

static bool take_value(const struct arguments_entry *entry, const char *text)
{
    switch (entry->kind) {
    case ARGUMENTS_NUMBER:
        return take_number(entry, text);
    case ARGUMENTS_CHOICE:
        return take_choice(entry, text);
    case ARGUMENTS_TEXT:
        *(const char **)entry->value = text;
        return true;
    case ARGUMENTS_FLAG:
        break;
    }
    *(bool *)entry->value = true;
    return true;
}

/* Takes the option at argv[*i] and moves *i past what it used. */
static bool take_option(const struct arguments_page *page, int argc, char **argv, int *i)
{
    const char *text = argv[(*i)++];
    const bool is_long = text[1] == '-';
    const char *name = is_long ? text + 2 : text + 1;
    const char *equals = is_long ? strchr(name, '=') : NULL;
    const size_t length = equals != NULL ? (size_t)(equals - name) : strlen(name);
    const bool lone_letter = !is_long && length == 1;
    const struct arguments_entry *entry =
        is_long || lone_letter ? find_entry(page, name, length, lone_letter ? name[0] : 0)
                               : NULL;
    if (entry == NULL) {
        report_error("there is no option %s; see %s --help", text, page->tool);
        return false;
    }
    if (entry->kind == ARGUMENTS_FLAG && equals != NULL) {
        report_error("--%s takes no value; leave out \"%s\"", entry->name, equals);
        return false;
    }
    if (entry->kind == ARGUMENTS_FLAG || equals != NULL)
        return take_value(entry, equals != NULL ? equals + 1 : "");
    if (*i >= argc) {
        report_error("--%s needs a value; see %s --help", entry->name, page->tool);
        return false;
    }
    return take_value(entry, argv[(*i)++]);
}

static int check_count(const struct arguments_page *page, int n)
{
    if (n >= page->n_least && n <= page->n_most)
        return ARGUMENTS_GO_ON;
    report_error("%d argument%s given; usage: %s %s", n, n == 1 ? " is" : "s are", page->tool,
                 page->usage);
    return REPORT_BAD_INPUT;
}

int arguments_read(const struct arguments_page *page, int argc, char **argv, int *n)
{
    *n = 0;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--") == 0)
            break;
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
            print_help(page);
            return REPORT_FINISHED;
        }
    }
    for (int i = 1; i < argc;) {
        if (strcmp(argv[i], "--") == 0) {
            for (i++; i < argc; i++)
                argv[++*n] = argv[i];
        } else if (argv[i][0] == '-' && argv[i][1] != '\0') {
            if (!take_option(page, argc, argv, &i))
                return REPORT_BAD_INPUT;
        } else {
            argv[++*n] = argv[i++];
        }
    }
    return check_count(page, *n);
}
