// A stack in registers: on llvmpipe, an array takes half as much time again. TREE_STACK entries are enough for
// the tree of the scene; the others are compiled out.

struct TreeStack {
    uvec2 e0, e1, e2, e3, e4, e5, e6, e7, e8, e9, e10, e11, e12, e13, e14, e15;
};

TreeStack empty_stack() {
    uvec2 none = uvec2(0u);
    return TreeStack(none, none, none, none, none, none, none, none, none, none, none, none, none, none,
                     none, none);
}

void push_if(bool pushes, uvec2 entry, inout TreeStack s) {
    if (TREE_STACK > 12) {
        s.e15 = pushes ? s.e14 : s.e15;
        s.e14 = pushes ? s.e13 : s.e14;
        s.e13 = pushes ? s.e12 : s.e13;
        s.e12 = pushes ? s.e11 : s.e12;
    }
    if (TREE_STACK > 8) {
        s.e11 = pushes ? s.e10 : s.e11;
        s.e10 = pushes ? s.e9 : s.e10;
        s.e9 = pushes ? s.e8 : s.e9;
        s.e8 = pushes ? s.e7 : s.e8;
    }
    if (TREE_STACK > 4) {
        s.e7 = pushes ? s.e6 : s.e7;
        s.e6 = pushes ? s.e5 : s.e6;
        s.e5 = pushes ? s.e4 : s.e5;
        s.e4 = pushes ? s.e3 : s.e4;
    }
    s.e3 = pushes ? s.e2 : s.e3;
    s.e2 = pushes ? s.e1 : s.e2;
    s.e1 = pushes ? s.e0 : s.e1;
    s.e0 = pushes ? entry : s.e0;
}

void pop_if(bool pops, inout TreeStack s) {
    s.e0 = pops ? s.e1 : s.e0;
    s.e1 = pops ? s.e2 : s.e1;
    s.e2 = pops ? s.e3 : s.e2;
    if (TREE_STACK > 4) {
        s.e3 = pops ? s.e4 : s.e3;
        s.e4 = pops ? s.e5 : s.e4;
        s.e5 = pops ? s.e6 : s.e5;
        s.e6 = pops ? s.e7 : s.e6;
    }
    if (TREE_STACK > 8) {
        s.e7 = pops ? s.e8 : s.e7;
        s.e8 = pops ? s.e9 : s.e8;
        s.e9 = pops ? s.e10 : s.e9;
        s.e10 = pops ? s.e11 : s.e10;
    }
    if (TREE_STACK > 12) {
        s.e11 = pops ? s.e12 : s.e11;
        s.e12 = pops ? s.e13 : s.e12;
        s.e13 = pops ? s.e14 : s.e13;
        s.e14 = pops ? s.e15 : s.e14;
    }
}
