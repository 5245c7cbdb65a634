// Tells parts of the page whether they can be seen, so that nothing else is drawn.

const callbacks = new WeakMap<Element, (is: boolean) => void>();
let observer: IntersectionObserver | undefined;

/** An attachment: calls back when an element comes into sight, or near it, and when it goes. */
export function seen(callback: (is: boolean) => void) {
  return (element: Element): (() => void) => {
    observer ??= new IntersectionObserver(
      (entries) => {
        for (const entry of entries) callbacks.get(entry.target)?.(entry.isIntersecting);
      },
      { rootMargin: '100px' },
    );
    const watching = observer;
    callbacks.set(element, callback);
    watching.observe(element);
    return () => {
      watching.unobserve(element);
      callbacks.delete(element);
    };
  };
}
