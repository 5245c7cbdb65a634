function main() { print("never"); }
print("text");
//> text
