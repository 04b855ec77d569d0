// The gate must see a call of the heap.
namespace landfix::test {

int* allocates(int value) { return new int(value); }

}  // namespace landfix::test
