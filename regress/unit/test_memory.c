/* Arrays whose room changes keep what counts of them, on their boundaries. */
#include "base/memory.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void test_resized(void **state)
{
    (void)state;
    uint32_t *array = NULL;
    size_t count = 0;
    for (size_t room = 1; room < 5000000; room = 3 * room / 2 + 1) {
        array = array_resized(array, count, room, sizeof *array);
        assert_true(array != NULL && (uintptr_t)array % 64 == 0);
        for (size_t i = 0; i < count; i++)
            assert_true(array[i] == (uint32_t)(7 * i));
        for (; count < room; count++)
            array[count] = (uint32_t)(7 * count);
    }
    array = array_resized(array, count, 1234, sizeof *array);
    assert_true(array != NULL && (uintptr_t)array % 64 == 0 && array[1233] == 7 * 1233);
    assert_null(array_resized(array, 1234, SIZE_MAX / 3, sizeof *array));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_resized)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
