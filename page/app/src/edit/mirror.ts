// The editor itself: CodeMirror, as this page uses it. It is loaded when the first text is edited.
//
// Owns languages, keys and colours. It is in a shadow root, where its styles are objects: the page allows no styles in its text.

import { defaultKeymap, history, historyKeymap } from '@codemirror/commands';
import { javascript } from '@codemirror/lang-javascript';
import { python } from '@codemirror/lang-python';
import {
  HighlightStyle,
  StreamLanguage,
  bracketMatching,
  indentOnInput,
  syntaxHighlighting,
} from '@codemirror/language';
import { lua } from '@codemirror/legacy-modes/mode/lua';
import { xml } from '@codemirror/legacy-modes/mode/xml';
import { type Diagnostic, lintGutter, lintKeymap, setDiagnostics } from '@codemirror/lint';
import { highlightSelectionMatches, search, searchKeymap } from '@codemirror/search';
import { Compartment, EditorState, type Extension, type Text } from '@codemirror/state';
import {
  EditorView,
  drawSelection,
  highlightActiveLine,
  highlightActiveLineGutter,
  keymap,
  lineNumbers,
} from '@codemirror/view';
import { tags } from '@lezer/highlight';
import type { Mark } from './marks';

/** The language of a text, by the end of its name. */
const LANGUAGES: Record<string, () => Extension> = {
  py: python,
  js: javascript,
  lua: () => StreamLanguage.define(lua),
  xml: () => StreamLanguage.define(xml),
};

/** Colours of the page, which follow the scheme by themselves. */
const colours = HighlightStyle.define([
  { tag: [tags.keyword, tags.operatorKeyword, tags.modifier], color: 'var(--line-4)' },
  { tag: [tags.string, tags.special(tags.string)], color: 'var(--line-3)' },
  { tag: [tags.number, tags.bool, tags.null, tags.atom], color: 'var(--line-2)' },
  { tag: tags.comment, color: 'var(--dim)', fontStyle: 'italic' },
  { tag: [tags.tagName, tags.angleBracket], color: 'var(--line-1)' },
  { tag: tags.attributeName, color: 'var(--line-2)' },
  { tag: [tags.definition(tags.variableName), tags.function(tags.variableName)], color: 'var(--line-1)' },
]);

const look = EditorView.theme({
  '&': { height: '100%', color: 'var(--ink)', backgroundColor: 'var(--raised)', fontSize: '0.9rem' },
  '&.cm-focused': { outline: '3px solid var(--accent)', outlineOffset: '1px' },
  '.cm-scroller': { fontFamily: 'ui-monospace, monospace', lineHeight: '1.45' },
  '.cm-content': { caretColor: 'var(--ink)' },
  '.cm-cursor': { borderLeftColor: 'var(--ink)' },
  '.cm-gutters': {
    backgroundColor: 'var(--back)',
    color: 'var(--dim)',
    borderRight: '1px solid var(--line)',
  },
  '.cm-activeLine, .cm-activeLineGutter': {
    backgroundColor: 'color-mix(in srgb, var(--hover) 50%, transparent)',
  },
  '.cm-activeLineGutter': { color: 'var(--ink)' },
  '.cm-selectionBackground, &.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground': {
    backgroundColor: 'color-mix(in srgb, var(--accent) 35%, transparent)',
  },
  '.cm-matchingBracket, &.cm-focused .cm-matchingBracket': { backgroundColor: 'var(--hover)' },
  '.cm-panels, .cm-tooltip': {
    backgroundColor: 'var(--raised)',
    color: 'var(--ink)',
    border: '1px solid var(--line)',
  },
  '.cm-textfield, .cm-button': {
    backgroundColor: 'var(--raised)',
    backgroundImage: 'none',
    color: 'var(--ink)',
    border: '1px solid var(--line)',
  },
});

/** What an editor is made with. */
export interface Options {
  text: string;
  /** `py`, `js`, `lua` or `xml`; any other is plain text. */
  language: string;
  /** For those who listen. */
  label: string;
  isFixed: boolean;
  /** The words of the search and of errors in the language of the page, by their English ones. */
  phrases: Record<string, string>;
  changed(text: string): void;
  /** Ctrl+S. */
  save(): void;
}

export class Mirror {
  readonly #view: EditorView;
  readonly #fixed = new Compartment();

  constructor(parent: ShadowRoot, options: Options) {
    const language = LANGUAGES[options.language];
    this.#view = new EditorView({
      root: parent,
      parent,
      state: EditorState.create({
        doc: options.text,
        extensions: [
          // First: the browser's own search finds nothing in lines that are not drawn.
          keymap.of([{ key: 'Mod-s', preventDefault: true, run: () => (options.save(), true) }]),
          keymap.of([...searchKeymap, ...historyKeymap, ...lintKeymap, ...defaultKeymap]),
          lineNumbers(),
          lintGutter(),
          history(),
          drawSelection(),
          indentOnInput(),
          bracketMatching(),
          highlightActiveLine(),
          highlightActiveLineGutter(),
          highlightSelectionMatches(),
          search({ top: true }),
          syntaxHighlighting(colours),
          language ? language() : [],
          look,
          EditorState.lineSeparator.of(endOfLines(options.text)),
          EditorState.phrases.of(options.phrases),
          // An editor that scrolls is reached by the keyboard.
          EditorView.contentAttributes.of({ 'aria-label': options.label, tabindex: '0' }),
          this.#fixed.of(EditorState.readOnly.of(options.isFixed)),
          EditorView.updateListener.of((update) => {
            if (update.docChanged) options.changed(update.state.sliceDoc());
          }),
        ],
      }),
    });
  }

  /** With the ends of lines that it came with. */
  get text(): string {
    return this.#view.state.sliceDoc();
  }

  /** Another text, as a change that can be undone. */
  set text(text: string) {
    if (text === this.text) return;
    this.#view.dispatch({ changes: { from: 0, to: this.#view.state.doc.length, insert: text } });
  }

  set isFixed(is: boolean) {
    this.#view.dispatch({ effects: this.#fixed.reconfigure(EditorState.readOnly.of(is)) });
  }

  set marks(marks: Mark[]) {
    const doc = this.#view.state.doc;
    const found = marks.map((mark) => diagnostic(doc, mark)).sort((one, other) => one.from - other.from);
    this.#view.dispatch(setDiagnostics(this.#view.state, found));
  }

  /** The next key is for this place of the text. */
  focus(at: number): void {
    this.#view.dispatch({ selection: { anchor: Math.min(at, this.#view.state.doc.length) } });
    this.#view.focus();
  }

  /** Shows a line, and puts the cursor there. */
  goTo(line: number): void {
    const { from } = this.#view.state.doc.line(within(this.#view.state.doc, line));
    this.#view.dispatch({
      selection: { anchor: from },
      effects: EditorView.scrollIntoView(from, { y: 'center' }),
    });
    this.#view.focus();
  }

  end(): void {
    this.#view.destroy();
  }
}

/** That of Windows only if all lines have it: others are kept as they are, as letters. */
const endOfLines = (text: string): string =>
  text.includes('\r\n') && !/(^|[^\r])\n/.test(text) ? '\r\n' : '\n';

const within = (doc: Text, line: number): number => Math.min(Math.max(line, 1), doc.lines);

/** The words of a line are marked, not the space before them. */
function diagnostic(doc: Text, mark: Mark): Diagnostic {
  const line = doc.line(within(doc, mark.line));
  const indent = line.text.length - line.text.trimStart().length;
  return { from: Math.min(line.from + indent, line.to), to: line.to, severity: 'error', message: mark.text };
}
