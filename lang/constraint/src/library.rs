//! The templates of the present release, which every field may use with the prefix `ts:` without declaring them.
//!
//! Owns their bodies, which are our own: names, parameters, defaults and what they mean are those of the original, and so
//! is what fails: a template that tells a message needs one although its parameter has a default.

/// The library, in the form in which an author writes templates.
pub(super) const LIBRARY: &str = r##"<templates>
<template name="condition-event">
  <params>
    <param name="id" default=""/>
    <param name="settedUpInit" default="false"/>
    <param name="trigger"><trigger><success/></trigger></param>
    <param name="conditions"><condition><true/></condition></param>
  </params>
  <content><![CDATA[
    <event id="#{id}" settedUpInitially="#{settedUpInit}">#{conditions}<triggers>#{trigger}</triggers></event>
  ]]></content>
</template>
<template name="timer-success-event">
  <params>
    <param name="timeout"/>
    <param name="trigger" default=""/>
    <param name="forceDropOnTimeout" default="false"/>
  </params>
  <content><![CDATA[
    <ts:condition-event settedUpInit="true">
      <with param="conditions">
        <condition><timer timeout="#{timeout}" forceDropOnTimeout="#{forceDropOnTimeout}"/></condition>
      </with>
      <with param="trigger">#{trigger}<success/></with>
    </ts:condition-event>
  ]]></content>
</template>
<template name="set-object-warzone">
  <params>
    <param name="id" default=""/>
    <param name="settedUpInit" default="true"/>
    <param name="regionId"/>
    <param name="objectId" default="robot1"/>
    <param name="objectPoint" default="any"/>
    <param name="message" default=""/>
    <param name="trigger" default=""/>
    <param name="conditions" default=""/>
    <param name="not" default="not"/>
    <param name="glue" default="and"/>
  </params>
  <content><![CDATA[
    <ts:condition-event id="#{id}" settedUpInit="#{settedUpInit}">
      <with param="conditions">
        <conditions glue="#{glue}">
          <#{not}><inside objectId="#{objectId}" regionId="#{regionId}" objectPoint="#{objectPoint}"/></#{not}>
          #{conditions}
        </conditions>
      </with>
      <with param="trigger">#{trigger}<message text="#{message}"/><success/></with>
    </ts:condition-event>
  ]]></content>
</template>
<template name="set-robot-warzone">
  <params>
    <param name="id" default=""/>
    <param name="settedUpInit" default="true"/>
    <param name="regionId"/>
    <param name="objectPoint" default="any"/>
    <param name="message" default=""/>
    <param name="trigger" default=""/>
    <param name="conditions" default=""/>
    <param name="not" default="not"/>
    <param name="glue" default="and"/>
  </params>
  <content><![CDATA[
    <ts:set-object-warzone id="#{id}" objectId="robot1" regionId="#{regionId}" objectPoint="#{objectPoint}"
                           message="#{message}" not="#{not}" glue="#{glue}">
      <with param="trigger">#{trigger}</with>
      <with param="conditions">#{conditions}</with>
    </ts:set-object-warzone>
  ]]></content>
</template>
<template name="change-score-with-log">
  <params>
    <param name="id" default=""/>
    <param name="settedUpInit" default="false"/>
    <param name="trigger" default=""/>
    <param name="conditions"/>
    <param name="operation" default="sum"/>
    <param name="scoreVariable" default="total_score"/>
    <param name="value"/>
    <param name="message" default=""/>
  </params>
  <content><![CDATA[
    <ts:condition-event id="#{id}" settedUpInit="#{settedUpInit}">
      <with param="conditions">#{conditions}</with>
      <with param="trigger">
        <setter name="#{scoreVariable}"><#{operation} _1="${#{scoreVariable}}" _2="#{value}"/></setter>
        <message text="#{message}"/>
        #{trigger}
      </with>
    </ts:condition-event>
  ]]></content>
</template>
<template name="object-region-with-score">
  <params>
    <param name="id"/>
    <param name="settedUpInit" default="false"/>
    <param name="objectId" default="robot1"/>
    <param name="regionId"/>
    <param name="objectPoint" default="any"/>
    <param name="trigger" default=""/>
    <param name="conditions" default=""/>
    <param name="not" default="condition"/>
    <param name="operation" default="sum"/>
    <param name="scoreVariable" default="total_score"/>
    <param name="value"/>
    <param name="message" default=""/>
    <param name="glue" default="and"/>
  </params>
  <content><![CDATA[
    <ts:change-score-with-log id="#{id}" settedUpInit="#{settedUpInit}" operation="#{operation}"
                              scoreVariable="#{scoreVariable}" value="#{value}" message="#{message}">
      <with param="conditions">
        <conditions glue="#{glue}">
          <#{not}><inside objectId="#{objectId}" regionId="#{regionId}" objectPoint="#{objectPoint}"/></#{not}>
          #{conditions}
        </conditions>
      </with>
      <with param="trigger">#{trigger}</with>
    </ts:change-score-with-log>
  ]]></content>
</template>
<template name="robot-stop-in-region-with-score">
  <params>
    <param name="id"/>
    <param name="settedUpInit" default="false"/>
    <param name="regionId"/>
    <param name="objectPoint" default="any"/>
    <param name="trigger" default=""/>
    <param name="conditions" default=""/>
    <param name="not" default="condition"/>
    <param name="operation" default="sum"/>
    <param name="scoreVariable" default="total_score"/>
    <param name="value"/>
    <param name="message" default=""/>
    <param name="glue" default="and"/>
    <param name="left" default="left"/>
    <param name="right" default="right"/>
  </params>
  <content><![CDATA[
    <ts:object-region-with-score id="#{id}" settedUpInit="#{settedUpInit}" objectId="robot1" regionId="#{regionId}"
                                 objectPoint="#{objectPoint}" not="#{not}" operation="#{operation}"
                                 scoreVariable="#{scoreVariable}" value="#{value}" message="#{message}" glue="#{glue}">
      <with param="conditions">
        <equals _1="${robot1.#{left}.power}" _2="0"/>
        <equals _1="${robot1.#{right}.power}" _2="0"/>
        #{conditions}
      </with>
      <with param="trigger">#{trigger}</with>
    </ts:object-region-with-score>
  ]]></content>
</template>
<template name="robot-finish-in-region-with-score">
  <params>
    <param name="id"/>
    <param name="settedUpInit" default="false"/>
    <param name="regionId"/>
    <param name="objectPoint" default="any"/>
    <param name="trigger" default=""/>
    <param name="conditions" default=""/>
    <param name="not" default="condition"/>
    <param name="operation" default="sum"/>
    <param name="scoreVariable" default="total_score"/>
    <param name="value"/>
    <param name="message" default=""/>
    <param name="glue" default="and"/>
    <param name="left" default="left"/>
    <param name="right" default="right"/>
  </params>
  <content><![CDATA[
    <ts:robot-stop-in-region-with-score id="#{id}" settedUpInit="#{settedUpInit}" regionId="#{regionId}"
                                        objectPoint="#{objectPoint}" not="#{not}" operation="#{operation}"
                                        scoreVariable="#{scoreVariable}" value="#{value}" message="#{message}"
                                        glue="#{glue}" left="#{left}" right="#{right}">
      <with param="conditions">#{conditions}</with>
      <with param="trigger">#{trigger}<success/></with>
    </ts:robot-stop-in-region-with-score>
  ]]></content>
</template>
<template name="robot-start-with-score">
  <params>
    <param name="id"/>
    <param name="settedUpInit" default="false"/>
    <param name="trigger" default=""/>
    <param name="conditions" default=""/>
    <param name="operation" default="sum"/>
    <param name="scoreVariable" default="total_score"/>
    <param name="value"/>
    <param name="message" default=""/>
    <param name="left" default="left"/>
    <param name="right" default="right"/>
    <param name="glue1" default="and"/>
    <param name="glue2" default="or"/>
  </params>
  <content><![CDATA[
    <ts:change-score-with-log id="#{id}" settedUpInit="#{settedUpInit}" operation="#{operation}"
                              scoreVariable="#{scoreVariable}" value="#{value}" message="#{message}">
      <with param="conditions">
        <conditions glue="#{glue1}">
          <conditions glue="#{glue2}">
            <notEqual _1="${robot1.#{left}.power}" _2="0"/>
            <notEqual _1="${robot1.#{right}.power}" _2="0"/>
          </conditions>
          #{conditions}
        </conditions>
      </with>
      <with param="trigger">#{trigger}</with>
    </ts:change-score-with-log>
  ]]></content>
</template>
<template name="robot-start">
  <params>
    <param name="id"/>
    <param name="settedUpInit" default="true"/>
    <param name="trigger" default=""/>
    <param name="conditions" default=""/>
    <param name="left" default="left"/>
    <param name="right" default="right"/>
    <param name="glue" default="or"/>
  </params>
  <content><![CDATA[
    <ts:condition-event id="#{id}" settedUpInit="#{settedUpInit}">
      <with param="conditions">
        <conditions glue="#{glue}">
          <notEqual _1="${robot1.#{left}.power}" _2="0"/>
          <notEqual _1="${robot1.#{right}.power}" _2="0"/>
          #{conditions}
        </conditions>
      </with>
      <with param="trigger">#{trigger}</with>
    </ts:condition-event>
  ]]></content>
</template>
<template name="robot-stop">
  <params>
    <param name="id"/>
    <param name="settedUpInit" default="false"/>
    <param name="trigger" default=""/>
    <param name="conditions" default=""/>
    <param name="left" default="left"/>
    <param name="right" default="right"/>
    <param name="glue" default="and"/>
  </params>
  <content><![CDATA[
    <ts:condition-event id="#{id}" settedUpInit="#{settedUpInit}">
      <with param="conditions">
        <conditions glue="#{glue}">
          <equals _1="${robot1.#{left}.power}" _2="0"/>
          <equals _1="${robot1.#{right}.power}" _2="0"/>
          #{conditions}
        </conditions>
      </with>
      <with param="trigger">#{trigger}</with>
    </ts:condition-event>
  ]]></content>
</template>
<template name="is-undefined">
  <params>
    <param name="name"/>
  </params>
  <content><![CDATA[
    <equals><typeOf objectId="#{name}"/><string value="undefined"/></equals>
  ]]></content>
</template>
<template name="typeof">
  <params>
    <param name="name"/>
    <param name="type"/>
  </params>
  <content><![CDATA[
    <equals><typeOf objectId="#{name}"/><string value="#{type}"/></equals>
  ]]></content>
</template>
</templates>"##;
